"""Tables 1 to 4 of bench/paper."""
import concurrent.futures
import importlib.machinery
import importlib.util
import json
import os
import pathlib
import shutil
import statistics
import subprocess

_loader = importlib.machinery.SourceFileLoader("quality", str(pathlib.Path(__file__).resolve().parent / "quality"))
quality = importlib.util.module_from_spec(importlib.util.spec_from_loader("quality", _loader))
_loader.exec_module(quality)

SETS = {"clean": "ingolstadt-north", "scan": "ingolstadt-north-scan", "blocks": "delft", "mvs": "mvs", "airborne": "als/block-a"}
SYNTH = {"synth": [], "synth-scan": ["--scan"]}
CITY3D = {"airborne": "als/block-a-city3d"}
SYNTH_BUILDINGS = 20
A_EPS = [1, 5, 20, 40, 80]  # m², among which the fit chooses
KEPT = 0.05  # of the volume
ROBUST, PAPER, FITTED = "colod", "paper's rules", "paper's rules, A_eps fitted"
LAYERS = 3


def line(cells):
    return "| " + " | ".join(str(c) for c in cells) + " |"


def markdown(heads, rows):
    return "\n".join([line(heads), "|" + "---|" * len(heads), *map(line, rows)])


def mean(values, digits):
    return f"{statistics.mean(values):.{digits}f}" if values else "–"


def deviation(values, digits):
    return f"{statistics.stdev(values):.{digits}f}" if len(values) > 1 else "–"


def chosen_sets(a):
    return a.sets.split(",") if a.sets else [*SETS, *SYNTH]


def sources(a, name):
    """The files of a set, at most --subset of them, spread over the whole; none where it is absent."""
    folder = a.data / SETS[name] if name in SETS else a.out / "sources" / name
    if name in SYNTH and not (folder / "truth.json").exists():
        count = min(a.subset or SYNTH_BUILDINGS, SYNTH_BUILDINGS)
        command = [a.colod, "synth", "-o", str(folder), "--buildings", str(count), "--seed", "5", *SYNTH[name]]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    files = sorted(f for f in folder.glob("*") if f.suffix in quality.SUFFIXES) if folder.is_dir() else []
    if a.subset and len(files) > a.subset:
        files = [files[i * len(files) // a.subset] for i in range(a.subset)]
    return files


def build(a, files, out, *options):
    """report.json and the run's processor seconds; finished runs with the same options are taken as they are."""
    ns = [] if "--ns" in options else ["--ns", str(a.ns)]
    command = [a.colod, "build", *map(str, files), "-o", str(out), *ns, "--format", "ply", "--quiet", "--no-report-html", *map(str, options)]
    mark = out / "command.json"
    if mark.exists() and json.loads(mark.read_text())["command"] == command:
        return json.loads((out / "report.json").read_text()), json.loads(mark.read_text())["seconds"]
    shutil.rmtree(out, ignore_errors=True)
    _, seconds, _, error = quality.run(command, 24 * 3600)
    if not (out / "report.json").exists():
        raise SystemExit(f"paper: {' '.join(command)}: {error}")
    mark.write_text(json.dumps({"command": command, "seconds": seconds}))
    return json.loads((out / "report.json").read_text()), seconds


def mode_options(a, files, mode, set_name):
    if mode == ROBUST:
        return []
    return ["--rules", "paper", *(["--alcove-area", fitted_alcove_area(a, files, set_name)] if mode == FITTED else [])]


def run_mode(a, set_name, files, mode):
    names = {ROBUST: "robust", PAPER: "paper", FITTED: "fitted"}
    return build(a, files, a.out / "ours" / set_name / names[mode], *mode_options(a, files, mode, set_name))


def fitted_alcove_area(a, files, set_name):
    """The largest A_eps, which limits the alcoves that are found, that inverts no large plane: layer 0 keeps the finest layer's volume,
    by KEPT in the mean; where none does, the one that keeps it best. In favour of the paper's rules it is fitted on the set itself."""
    def off(area):
        report, _ = build(a, files, a.out / "ours" / set_name / f"a{area}", "--rules", "paper", "--alcove-area", area)
        whole = [b["layers"] for b in report["buildings"] if b["layers"] and all("faces" in layer for layer in b["layers"])]
        changes = [abs(layers[0]["volume"] / layers[-1]["volume"] - 1) for layers in whole if layers[-1]["volume"] > 0]
        return statistics.mean(changes) if changes else 1
    offs = {area: off(area) for area in A_EPS}
    kept = [area for area in A_EPS if offs[area] <= KEPT]
    return max(kept) if kept else min(A_EPS, key=offs.get)


def measure(a, source, models):
    """What bench_peers says of each model, None where it says nothing, and the source's diagonal."""
    done = subprocess.run([a.peers, "measure", str(source), *map(str, models)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
    if done.returncode != 0:
        return [None] * len(models), 1
    answer = json.loads(done.stdout)
    return answer["models"], answer["diagonal"]


def table1(a):
    rows = []
    for name in chosen_sets(a):
        files = sources(a, name)
        if not files:
            continue
        reports = {mode: run_mode(a, name, files, mode) for mode in (ROBUST, PAPER)}
        of = lambda report, key: mean([b[key] for b in report["buildings"]], 0)
        first = reports[ROBUST][0]
        own = [measure(a, f, [f])[0][0] for f in files] if first["buildings"][0]["faces"] else []
        own = [m for m in own if m]
        row = [name, of(first, "vertices"), of(first, "faces"), mean([m["components"] for m in own], 0), mean([m["self_intersections"] for m in own], 0)]
        for report, seconds in reports.values():
            row += [of(report, "planes"), of(report, "segments"), f"{seconds / len(files):.1f}"]
        rows.append([*row, len(files)])
    heads = ["set", "V", "F", "C", "I", "P", "S", "T, s", "P, paper", "S, paper", "T, paper, s", "M"]
    return ("Means of a building: vertices, faces, connected components and self-intersections of the input (clouds: points), planes, segments, "
            "seconds; M buildings.\n\n" + markdown(heads, rows))


def our_rows(a, set_name, files, mode):
    report, _ = run_mode(a, set_name, files, mode)
    names = {ROBUST: "robust", PAPER: "paper", FITTED: "fitted"}
    folder = a.out / "ours" / set_name / names[mode] / "buildings"
    rows = []
    for b in report["buildings"]:
        layers = {layer["layer"]: layer for layer in b["layers"] if "faces" in layer}
        for k in range(LAYERS):
            path = folder / f"{b['name']}.layer{k}.ply" if k in layers else None
            rows.append({"set": set_name, "building": b["name"], "source": b["source"], "method": mode, "layer": k, "path": path,
                         "faces_of_layer": layers[k]["faces"] if k in layers else None})
    return rows


def peer_rows(a, set_name, building, source, faces):
    """Every other method's model of a building: collapses to our faces on each layer, PolyFit and City3D once, on layer 0."""
    folder = a.out / "peers" / set_name
    folder.mkdir(parents=True, exist_ok=True)

    def model(program, given, name, wanted=None):
        path = folder / f"{building}.{name}.off"
        path.unlink(missing_ok=True)
        command = [a.peers, "run", program, str(given), str(path), *(["--faces", str(wanted)] if wanted else [])]
        code, _, _, _ = quality.run(command, a.limit)
        return path if code == 0 and path.exists() else None

    rows = []
    add = lambda method, layer, path: rows.append({"set": set_name, "building": building, "source": source, "method": method, "layer": layer, "path": path})
    wrap = model("wrap", source, "wrap")
    for k, wanted in faces.items():
        for program in ("meshopt", "quadrics"):
            add(quality.NAMES[program], k, model(program, source, f"{program}.{k}", wanted))
        add(quality.NAMES["wrap"], k, model("collapse", wrap, f"wrap.{k}", wanted) if wrap else None)
    add(quality.NAMES["polyfit"], 0, model("polyfit", source, "polyfit"))
    if set_name in CITY3D:
        theirs = a.data / CITY3D[set_name] / f"{building}.obj"
        add("City3D's own model", 0, theirs if theirs.exists() else None)
    return rows


def measured(a, rows):
    """The rows of one building with what is measured of each model."""
    shown = [r for r in rows if r["path"]]
    answers, _ = measure(a, rows[0]["source"], [r["path"] for r in shown])
    for row, answer in zip(shown, answers):
        row["measure"] = answer
    return rows


def comparison(rows, set_names):
    """Table 2 over some sets."""
    table = []
    for k in range(LAYERS):
        for method in dict.fromkeys(r["method"] for r in rows):
            own = [r for r in rows if r["set"] in set_names and r["layer"] == k and r["method"] == method]
            good = [r["measure"] for r in own if r.get("measure")]
            if not own:
                continue
            of = lambda key: [m[key] for m in good if key in m]
            lfd, program, hd = of("light_field_distance"), of("light_field_distance_program"), of("hausdorff_relative")
            table.append([k, method, mean(of("vertices"), 0), mean(of("faces"), 0), mean(of("polygons"), 0), f"{100 * len(good) / len(own):.0f} %",
                          f"{sum(m['watertight'] for m in good)}/{len(own)}", mean(program, 0), deviation(program, 0), mean(lfd, 0), mean(hd, 4), deviation(hd, 4)])
    return markdown(["layer", "method", "V", "F", "P", "r_s", "watertight", "LFD mean", "sd", "LFD, Zernike", "HD mean", "sd"], table)


def table2(a):
    rows, text = [], []
    for name in chosen_sets(a):
        files = sources(a, name)
        if not files:
            continue
        ours = [r for mode in (ROBUST, PAPER, FITTED) for r in our_rows(a, name, files, mode)]
        text.append(f"{name}: {len(files)} buildings, fitted A_eps {fitted_alcove_area(a, files, name)} m²")

        def one(building, own=ours, set_name=name):
            mine = [r for r in own if r["building"] == building]
            faces = {r["layer"]: r["faces_of_layer"] for r in mine if r["method"] == ROBUST and r["path"]}
            return measured(a, mine + peer_rows(a, set_name, building, mine[0]["source"], faces))

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for compared in pool.map(one, dict.fromkeys(r["building"] for r in ours)):
                rows += compared
    clouds = [name for name in chosen_sets(a) if name in CITY3D]
    meshes = [name for name in chosen_sets(a) if name not in CITY3D]
    note = ("r_s: a model with a face within the limit, of all buildings. LFD: as the authors' program describes silhouettes (`src/measure/light_field.h`); "
            "HD: of the diagonal. Collapses get the faces of our layer; PolyFit 20 of our planes, City3D's models are its authors'.")
    out = ["; ".join(text) + ".", note]
    for title, names in (("Meshes", meshes), ("Airborne clouds", clouds)):
        if any(r["set"] in names for r in rows):
            out.append(f"### {title}\n\n{comparison(rows, names)}")
    return "\n\n".join(out)


def times(report):
    """T_s, T_c, T_p: wall clock of the stages, of all buildings."""
    of = lambda *keys: sum(b["timings"][key] for b in report["buildings"] for key in keys)
    return of("planes", "visibility", "segments"), report["coanalysis"]["seconds"], of("extraction")


def database(a, exclude):
    """A scene file of made-up buildings, as many as have --segments segments."""
    folder, path = a.out / "database" / "synth", a.out / "database" / "database.colod"
    for count in range(4, 200, 4):
        subprocess.run([a.colod, "synth", "-o", str(folder), "--buildings", str(count), "--seed", str(exclude + 1000)],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        path.unlink(missing_ok=True)
        for stage in (["segment", str(folder), "-o", str(path), "--ns", str(a.ns)], ["analyze", str(path)]):
            subprocess.run([a.colod, *stage, "--quiet"], check=True, stdout=subprocess.DEVNULL)
        answer = subprocess.run([a.helper, "scaling", str(path)], check=True, stdout=subprocess.PIPE, text=True)
        segments = json.loads(answer.stdout)[-1]["segments"]
        if segments >= a.segments:
            return path, segments
    raise SystemExit("paper: no made-up street has so many segments; fewer --segments")


def single_reports(a, files, prior):
    return [build(a, [f], a.out / "single" / f.stem, "--prior", prior)[0] for f in files]


def table3(a):
    files = sources(a, "clean") or sources(a, "synth")
    prior, segments = database(a, 5)
    together, _ = build(a, files, a.out / "single" / "together")
    alone = single_reports(a, files, prior)
    rows = []
    for task, reports in (("S", alone), ("Co", [together])):
        spent = [sum(parts) for parts in zip(*map(times, reports))]
        for k in range(LAYERS):
            models = []
            for r in reports:
                for b in r["buildings"]:
                    folder = a.out / "single" / ("together" if r is together else b["name"])
                    models.append(measure(a, b["source"], [folder / "buildings" / f"{b['name']}.layer{k}.ply"])[0][0])
            good = [m for m in models if m]
            of = lambda key, digits: mean([m[key] for m in good if key in m], digits)
            rows.append([f"{task} {k}", of("faces", 0), of("vertices", 0), of("hausdorff_relative", 4), of("light_field_distance_program", 0),
                         *([f"{s:.2f}" for s in spent] if k == 0 else ["", "", ""])])
    return (f"{len(files)} buildings, each alone with a database of {segments} segments of made-up buildings (S), or together (Co). T: wall clock of all.\n\n"
            + markdown(["task and layer", "F", "V", "HD", "LFD", "T_s, s", "T_c, s", "T_p, s"], rows))


def segmented(a, files, path, options):
    """A scene file with segments, and nothing else, for the detection rate."""
    path.unlink(missing_ok=True)
    path.parent.mkdir(parents=True, exist_ok=True)
    subprocess.run([a.colod, "segment", *map(str, files), "-o", str(path), "--quiet", *options], check=True, stdout=subprocess.DEVNULL)
    return path


def detection(a, files, option, values, further, rules):
    """Rows of Table 4: distances of the finest layer, times, structures of the last value that are found."""
    rows, scenes = [], {}
    for value in values:
        options = [option, str(value), *further, "--rules", rules]
        scenes[value] = segmented(a, files, a.out / "rays" / f"{rules}{option}{value}.colod", options)
    for value in values:
        options = [option, str(value), *further, "--rules", rules]
        out = a.out / "rays" / f"{rules}{option}{value}"
        report, _ = build(a, files, out, *options)
        models = [m for b in report["buildings"] for m in
                  measure(a, b["source"], [out / "buildings" / f"{b['name']}.layer{LAYERS - 1}.ply"])[0] if m]
        found = json.loads(subprocess.run([a.helper, "detected", str(scenes[values[-1]]), str(scenes[value])],
                                          check=True, stdout=subprocess.PIPE, text=True).stdout)
        spent = times(report)
        hd = [m["hausdorff_relative"] for m in models]
        rows.append([rules, value, mean(hd, 4), deviation(hd, 4), mean([m["light_field_distance_program"] for m in models if "light_field_distance_program" in m], 0),
                     f"{spent[0]:.1f}", f"{spent[2]:.1f}", found["segments"], f"{100 * found['rate']:.1f} %"])
    return rows


def table4(a):
    files = sources(a, "scan") or sources(a, "synth-scan")
    rays = [5, 30, 100, 200] if a.small else [5, 10, 30, 60, 100, 150, 200]
    voxels = [30, 60, 100] if a.small else [50, 75, 100, 150, 200, 300]
    heads = ["rules", "{}", "HD mean", "sd", "LFD", "T_s, s", "T_p, s", "segments", "SDR"]
    out = [f"{len(files)} scans. SDR: segments of the last value to which one is alike, an IoU of area of at least a half, each at most once. T: wall clock of all."]
    for name, option, values in (("n_r", "--nr", rays), ("n_s", "--ns", voxels)):
        rows = [row for rules in ("robust", "paper") for row in detection(a, files, option, values, [], rules)]
        out.append(markdown([h.format(name) for h in heads], rows))
    return "\n\n".join(out)
