#!/usr/bin/env python3
"""Runs colod on folders of buildings under both rules and prints the tables of docs/rules.md as Markdown.

usage: tables.py --colod build/release/colod [--ns 60] [--rules robust,paper,paper:20] [--out FOLDER] NAME=PATH...
paper:20 are the paper's rules with an A_eps of 20 m². Each NAME=PATH is a scene: a file or a folder given to `colod build`.
"""
import argparse
import json
import os
import pathlib
import platform
import statistics
import subprocess
import tempfile


def machine():
    model = "unknown processor"
    for line in open("/proc/cpuinfo", encoding="utf-8"):
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    return f"{model}, {os.cpu_count()} cores, {platform.system()}"


def build(colod, path, rules, ns, out):
    name, _, alcove_area = rules.partition(":")
    command = [colod, "build", path, "-o", out, "--rules", name, "--ns", str(ns), "--quiet", "--format", "glb", "--no-report-html"]
    command += ["--alcove-area", alcove_area] if alcove_area else []
    result = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False)
    report = pathlib.Path(out) / "report.json"
    return result.returncode, json.loads(report.read_text()) if report.exists() else None


def median(values, digits=4):
    values = [v for v in values if v is not None]
    return f"{statistics.median(values):.{digits}f}" if values else "–"


def scene_row(name, rules, code, report):
    if report is None:
        return f"| {name} | {rules} | {code} | no report |"
    buildings = report["buildings"]
    layers = [layer for b in buildings for layer in b["layers"]]
    good = [layer for layer in layers if layer.get("watertight")]
    finest = [(b, b["layers"][-1]) for b in buildings if b["layers"] and "faces" in b["layers"][-1]]
    count = lambda k: [b["layers"][k]["polygons"] for b in buildings if len(b["layers"]) > k and "polygons" in b["layers"][k]]
    relative_mean = [layer["mean_distance"] / b["diagonal"] for b, layer in finest]
    volume = [abs(b["layers"][0]["volume"] / layer["volume"] - 1) for b, layer in finest
              if "volume" in b["layers"][0] and layer["volume"]]
    wanted = len(buildings) * report["parameters"]["layers"]
    totals = report["totals"]
    return (f"| {name} | {rules} | {code} | {len(buildings)} | {len(good)}/{wanted} | "
            f"{median([b['segments'] for b in buildings], 1)} | "
            f"{median(count(0), 0)}/{median(count(1), 0)}/{median(count(2), 0)} | "
            f"{median([layer['hausdorff_relative'] for _, layer in finest])} | {median(relative_mean)} | "
            f"{max(volume, default=0):.2f} | {sum(layer['self_intersections'] for layer in good)} | "
            f"{totals['seconds']:.0f} | {totals['rays_per_second'] / 1e6:.1f} | {totals['peak_memory_bytes'] / 2**20:.0f} |")


def building_rows(report):
    for b in report["buildings"]:
        for layer in b["layers"]:
            if "faces" not in layer:
                yield f"| {b['name']} | {layer['layer']} | failed: {layer.get('failure', '')} |"
                continue
            yield (f"| {b['name']} | {layer['layer']} | {layer['segments']} | {layer['vertices']} | {layer['faces']} | "
                   f"{layer['polygons']} | {'yes' if layer['watertight'] else 'NO'} | "
                   f"{'yes' if layer['manifold'] else 'NO'} | {layer['self_intersections']} | {layer['volume']:.0f} | "
                   f"{layer['hausdorff_relative']:.4f} | {layer['mean_distance'] / b['diagonal']:.5f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--colod", required=True)
    parser.add_argument("--ns", type=int, default=60)
    parser.add_argument("--rules", default="robust,paper")
    parser.add_argument("--out", help="keep the outputs here")
    parser.add_argument("--buildings", action="store_true", help="also a table with every building")
    parser.add_argument("scenes", nargs="+", metavar="NAME=PATH")
    a = parser.parse_args()
    print(f"Machine: {machine()}. n_s {a.ns}.\n")
    print("| scene | rules | exit | buildings | watertight layers | segments (median) | polygons 0/1/2 (median) | "
          "HD rel. | mean / diagonal | volume 0 off by (max) | self-int. | s | Mrays/s | MiB |")
    print("|" + "---|" * 14)
    details = []
    with tempfile.TemporaryDirectory() as scratch:
        for scene in a.scenes:
            name, path = scene.split("=", 1)
            for rules in a.rules.split(","):
                out = str(pathlib.Path(a.out or scratch) / f"{name}-{rules}")
                code, report = build(a.colod, path, rules, a.ns, out)
                print(scene_row(name, rules, code, report), flush=True)
                if report and a.buildings:
                    details.append((name, rules, list(building_rows(report))))
    for name, rules, rows in details:
        print(f"\n### {name}, {rules}\n\n| building | layer | segments | vertices | faces | polygons | watertight | manifold | "
              "self-int. | volume m³ | HD rel. | mean / diagonal |\n" + "|" + "---|" * 12)
        print("\n".join(rows))


if __name__ == "__main__":
    main()
