"""Takes each rule away alone and tabulates what changes, set by set: `bench/ablation --rules`.

usage: ablation --rules [NAMES] [--build build/release] [--data ../shared/data] [--sets delft,...] [--sample N] [--jobs J] [--ns 60]
                [--seed 77] [--out docs/log/ablation-rules.md]

NAMES: ids of `colod rules`, with commas; none: all of them. Per set one run with all rules on, then one a rule, `colod build --without
RULE`. --sample N takes the N buildings of a set whose file names have the least SHA-256. Sets of `colod synth` have a seed that no rule
was made on, and are held against their truth. Results are kept in BUILD/ablation-rules under a hash of the program, the files of the set
and the rule: a run that was broken off goes on. Only the standard library is used.
"""
import argparse
import concurrent.futures
import hashlib
import json
import math
import pathlib
import statistics
import subprocess
import tempfile

SETS = {name: name for name in ("delft", "als/block-a", "ingolstadt-north", "ingolstadt-north-scan", "mvs", "mvs-with-ground", "points")}
SETS |= {name: f"scenes/{name}" for name in ("bocimi-buildings", "machangara-buildings")}
SYNTH = {"synth": [], "synth-scan": ["--scan"]}
SUFFIXES = {".obj", ".ply", ".off", ".stl", ".gltf", ".glb", ".xyz"}
NONE = ""  # no rule taken away
LAYERS = 3

INTRODUCTION = """# Rules, one by one

Written by `bench/ablation --rules`. Each rule is taken away alone, and with it what needs it (`--without`); figures are ratios to all rules
on, over buildings that came through in both runs: means of the mean distance (source → layer, over the diagonal) and sums of polygons, of
layers 0 / 1 / 2. Over 1 in *distance* the rule brings the layers nearer. *fails*: buildings that failed, + layers that failed or were
replaced, + bodies lost, all on → without. *agree*: parts of the truth on their type's majority layer, all on → without. A set on which the
rule was made is marked `*`: the others are its test. Sets that a rule does not change are named, not listed.

n_s {ns}; {sample}; `colod synth` seed {seed}.
"""


def digest(*parts):
    return hashlib.sha256("\0".join(map(str, parts)).encode()).hexdigest()[:24]


def file_digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def least(files, count):
    """Those whose names have the least hash: a choice that other files do not change."""
    ordered = sorted(files, key=lambda f: hashlib.sha256(f.name.encode()).hexdigest())
    return sorted(ordered[:count] if count else ordered)


def collect(a, name):
    """The files of a set and what `colod build` needs besides."""
    if name not in SYNTH:
        folder = a.data / SETS[name]
        files = [f for f in folder.glob("*") if f.suffix.lower() in SUFFIXES] if folder.is_dir() else []
        return least(files, a.sample), []
    count = a.sample or 20
    folder = a.cache / digest(name, a.seed, count, a.program)
    if not (folder / "truth.json").exists():
        subprocess.run([a.colod, "synth", "-o", folder, "--buildings", str(count), "--seed", str(a.seed), *SYNTH[name]], check=True,
                       stderr=subprocess.DEVNULL)
    return least([f for f in folder.glob("*") if f.suffix in SUFFIXES], 0), ["--truth", str(folder / "truth.json")]


def summary(report):
    buildings = {}
    for b in report["buildings"]:
        whole = len(b["layers"]) == LAYERS and all("polygons" in layer for layer in b["layers"])
        buildings[b["name"]] = {"mean": [layer["mean_distance"] / b["diagonal"] for layer in b["layers"]],
                                "polygons": [layer["polygons"] for layer in b["layers"]]} if whole else None
    types = report.get("consistency", {}).values()
    seen = sum(t["seen"] for t in types)
    totals = report["totals"]
    return {"buildings": buildings,
            "fails": [totals["failed_buildings"], totals["failed_layers"] + totals["stand_in_layers"], totals["lost_bodies"]],
            "agree": sum(max(t["first"]) for t in types) / seen if seen else None}


def measure(a, name, files, more, rule):
    """The summary of a run, from the cache where it is there."""
    key = digest(a.program, name, a.ns, *(f"{f.name} {file_digest(f)}" for f in files), rule)
    kept = a.cache / f"{key}.json"
    if kept.exists():
        return json.loads(kept.read_text())
    with tempfile.TemporaryDirectory() as out:
        command = [a.colod, "build", *files, "-o", out, "--ns", a.ns, "--format", "obj", "--no-report-html", "--quiet", *more,
                   "--threads", 1 if a.jobs > 1 else 0, *(["--without", rule] if rule else [])]
        result = subprocess.run(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
        report = pathlib.Path(out) / "report.json"
        if result.returncode not in (0, 1, 4) or not report.exists():
            raise SystemExit(f"ablation: {name} without {rule or 'nothing'}: exit code {result.returncode}: {result.stderr.strip()}")
        answer = summary(json.loads(report.read_text()))
    part = kept.with_suffix(".part")
    part.write_text(json.dumps(answer))
    part.rename(kept)
    return answer


def ratios(without, all_on, what, total):
    """Per layer, over buildings that came through in both."""
    both = [n for n, b in all_on["buildings"].items() if b and without["buildings"].get(n)]
    result = []
    for k in range(LAYERS if both else 0):
        new, old = (total(run["buildings"][n][what][k] for n in both) for run in (without, all_on))
        result.append(new / old if old > 0 else 1.0 if new == old else math.inf)
    return result


def compare(without, all_on):
    if without == all_on:
        return None
    return {"mean": ratios(without, all_on, "mean", statistics.mean), "polygons": ratios(without, all_on, "polygons", sum),
            "fails": (all_on["fails"], without["fails"]), "agree": (all_on["agree"], without["agree"])}


def numbers(values):
    return " / ".join(f"{v:.2f}" for v in values) if values else "–"


def row(rule, name, change):
    mark = " *" if name in rule["made_on"] else ""
    fails = " → ".join(" + ".join(map(str, f)) for f in change["fails"])
    agree = " → ".join(f"{100 * v:.0f} %" for v in change["agree"]) if None not in change["agree"] else ""
    return f"| {name}{mark} | {numbers(change['mean'])} | {numbers(change['polygons'])} | {fails} | {agree} |"


def section(rule, changes):
    title = rule["title"][0].upper() + rule["title"][1:]
    lines = [f"## {rule['id']}", "", title + f" ([page](../rules/{rule['id']}.md)).", ""]
    changed = {name: c for name, c in changes.items() if c}
    if changed:
        lines += ["| without it, on | distance | polygons | fails | agree |", "|---|---|---|---|---|"]
        lines += [row(rule, name, c) for name, c in changed.items()] + [""]
    if same := [name for name, c in changes.items() if not c]:
        lines += ["Changes nothing on: " + ", ".join(same) + ".", ""]
    return "\n".join(lines)


def middle(changes, what):
    """Geometric mean over sets and layers; a set that does not change counts as 1."""
    values = [v for c in changes for v in (c[what] if c else [1.0] * LAYERS) if 0 < v < math.inf]
    return f"{statistics.geometric_mean(values):.3f}" if values else "–"


def overview(rules, table):
    lines = ["| rule | sets changed | distance, test sets | polygons, test sets | distance, made on | polygons, made on |", "|---|---|---|---|---|---|"]
    for rule in rules:
        changes = table[rule["id"]]
        test = [c for name, c in changes.items() if name not in rule["made_on"]]
        own = [c for name, c in changes.items() if name in rule["made_on"]]
        lines.append(f"| [{rule['id']}](#{rule['id'].replace('.', '')}) | {sum(map(bool, changes.values()))} of {len(changes)} | {middle(test, 'mean')} | "
                     f"{middle(test, 'polygons')} | {middle(own, 'mean')} | {middle(own, 'polygons')} |")
    return "\n".join(lines)


def run_all(a, rules):
    """Rule → set → what changes."""
    sets = {name: collect(a, name) for name in a.sets}
    for name in [n for n, (files, _) in sets.items() if not files]:
        print(f"ablation: {name} is not there", flush=True)
        del sets[name]
    work = [(name, rule) for name in sets for rule in [NONE, *(r["id"] for r in rules)]]
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        done = dict(zip(work, pool.map(lambda w: measure(a, w[0], *sets[w[0]], w[1]), work)))
    return {r["id"]: {name: compare(done[name, r["id"]], done[name, NONE]) for name in sets} for r in rules}


def main(arguments):
    root = pathlib.Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(prog="ablation", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rules", nargs="?", const="", required=True, help="ids, with commas; none: all")
    parser.add_argument("--build", type=pathlib.Path, default=root / "build/release", help="the build folder")
    parser.add_argument("--data", type=pathlib.Path, default=root / "../shared/data")
    parser.add_argument("--sets", default=",".join([*SETS, *SYNTH]))
    parser.add_argument("--sample", type=int, default=0, help="buildings of a set; 0: all, 20 of synth")
    parser.add_argument("--jobs", type=int, default=1, help="runs at once, each on one thread; 1: one run on all")
    parser.add_argument("--ns", type=int, default=60)
    parser.add_argument("--seed", type=int, default=77, help="of colod synth")
    parser.add_argument("--out", type=pathlib.Path, default=root / "docs/log/ablation-rules.md")
    a = parser.parse_args(arguments)
    a.sets = a.sets.split(",")
    if unknown := [name for name in a.sets if name not in SETS and name not in SYNTH]:
        parser.error(f"no set {', '.join(unknown)}; there are {', '.join([*SETS, *SYNTH])}")
    a.colod = a.build / "colod"
    a.program = file_digest(a.colod)
    a.cache = a.build / "ablation-rules"
    a.cache.mkdir(exist_ok=True)
    rules = json.loads(subprocess.run([a.colod, "rules", "--json"], check=True, stdout=subprocess.PIPE, text=True).stdout)
    if a.rules:
        wanted = a.rules.split(",")
        if unknown := set(wanted) - {r["id"] for r in rules}:
            parser.error(f"no rule {', '.join(sorted(unknown))}: colod rules lists them")
        rules = [r for r in rules if r["id"] in wanted]
    table = run_all(a, rules)
    sample = f"the {a.sample} buildings of a set whose file names have the least SHA-256" if a.sample else "all buildings of a set"
    page = [INTRODUCTION.format(ns=a.ns, sample=sample, seed=a.seed), overview(rules, table), "", *(section(r, table[r["id"]]) for r in rules)]
    a.out.write_text("\n".join(page))
    print(f"ablation: {len(rules)} rules written to {a.out}")
