"""Ablations with pictures, similarities and scaling of bench/paper."""
import argparse
import json
import statistics
import subprocess

import paper_tables as t

SWEEPS = {
    "alcove-area": ("A_eps, m²", [5, 20, 80, 200]),
    "lambda": ("λ", [0, 0.4, 4]),
    "beta": ("β", [0, 0.3, 3]),
    "eta": ("η", [1, 4, 16]),
    "layers": ("l_n", [2, 3, 4]),
}
STREET = ("synth", 4)  # buildings of the street that is shown


def street(a):
    name, count = STREET
    files = t.sources(a, name)
    return files[:count]


def row(rules, value, report):
    segments = sum(b["segments"] for b in report["buildings"])
    layers = [layer for b in report["buildings"] for layer in b["layers"]]
    up_to = [sum(layer["segments"] for layer in layers if layer["layer"] == k) for k in range(report["parameters"]["layers"])]
    coarsest = [layer["polygons"] for layer in layers if layer["layer"] == 0 and "polygons" in layer]
    own = [up_to[0], *(b - a for a, b in zip(up_to, up_to[1:]))]
    watertight = sum(layer.get("watertight", False) for layer in layers)
    return [rules, value, segments, "/".join(map(str, own)), f"{statistics.mean(coarsest):.0f}" if coarsest else "–", f"{watertight}/{len(layers)}"]


def picture(a, folders, values, out):
    """A row a house of the street, which share a camera; a column a value: layer 0."""
    files = []
    for house in sorted(mesh.name.split(".")[0] for mesh in (folders[0] / "buildings").glob("*.layer0.ply")):
        for value, folder in zip(values, folders):
            link = a.out / "pictures" / out.stem / f"{value} {house}.ply"
            link.parent.mkdir(parents=True, exist_ok=True)
            link.unlink(missing_ok=True)
            mesh = folder / "buildings" / f"{house}.layer0.ply"
            if mesh.exists():
                link.symlink_to(mesh.resolve())
            else:
                link = link.with_suffix(".off")
                link.write_text(t.quality.NO_PICTURE)
            files.append(str(link))
    subprocess.run([a.colod, "preview", *files, "-o", str(out), "--columns", str(len(values)), "--width", "300", "--height", "240"], check=True)


def ablations(a):
    files = street(a)
    out = [f"{len(files)} made-up buildings; on the pictures a row each and a column a value: layer 0."]
    for option, (title, values) in SWEEPS.items():
        rows = []
        for rules in ("robust", "paper"):
            folders = [a.out / "ablations" / f"{rules}-{option}-{value}" for value in values]
            for value, folder in zip(values, folders):
                rows.append(row(rules, value, t.build(a, files, folder, "--rules", rules, f"--{option}", value)[0]))
            image = a.out / f"{option}-{rules}.png"
            picture(a, folders, values, image)
        heads = ["rules", title, "segments", "by layer", "polygons of layer 0", "watertight"]
        pictures = "\n\n".join(f"![layer 0 by {title}, {rules}]({option}-{rules}.png)" for rules in ("robust", "paper"))
        out.append(f"### {title}\n\n{t.markdown(heads, rows)}\n\n{pictures}")
    return "\n\n".join(out)


def matrix(a):
    scene = t.segmented(a, street(a), a.out / "matrix.colod", ["--ns", str(a.ns)])
    subprocess.run([a.helper, "matrix", str(scene), str(a.out / "matrix.png")], check=True)
    return ("dis (left; white is the largest) and Sim_co = exp(−dis) (right; white is 1) between all segments of the street, building after building.\n\n"
            "![dis and Sim_co between segments](matrix.png)")


def scaling(a):
    rows = []
    every = argparse.Namespace(**{**vars(a), "subset": None})  # clouds are small: all of them, in the small mode, too
    for name, files in (("airborne", t.sources(every, "airborne")), ("scan", t.sources(a, "scan"))):
        if not files:
            continue
        for rules in ("robust", "paper"):
            scene = t.segmented(a, files, a.out / "scaling" / f"{name}-{rules}.colod", ["--ns", str(a.ns), "--rules", rules])
            answer = subprocess.run([a.helper, "scaling", str(scene), "--rules", rules], check=True, stdout=subprocess.PIPE, text=True)
            rows += [[name, rules, r["buildings"], r["segments"], f"{r['seconds']:.3f}", f"{100 * r['gap']:.2f} %"] for r in json.loads(answer.stdout)]
    return t.markdown(["set", "rules", "buildings", "segments", "seconds", "gap"], rows)
