"""The Python module: numpy in and out, files, errors, Ctrl-C."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import colod
import numpy as np

ASSETS = pathlib.Path(__file__).parents[2] / "assets" / "neighbourhood-clean"
QUICK = {"ns": 24, "layers": 2, "no_report_html": True}


def box(w, d, h):
    points = np.array([[x, y, z] for z in (0, h) for x, y in ((0, 0), (w, 0), (w, d), (0, d))], float)
    triangles = [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]]
    for k in range(4):
        n = (k + 1) % 4
        triangles += [[k, n, n + 4], [k, n + 4, k + 4]]
    return points, np.array(triangles)


def volume(mesh):
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


class Build(unittest.TestCase):
    def test_arrays(self):
        scene = colod.build({"b": box(12, 8, 6), "a": box(10, 9, 5)}, **QUICK)
        self.assertEqual(scene.status, 0)
        self.assertEqual([b.name for b in scene.buildings], ["a", "b"])
        finest = scene.buildings[1].layers[-1]
        mesh = finest.mesh
        self.assertAlmostEqual(volume(mesh), 12 * 8 * 6, places=2)
        self.assertEqual(mesh.points.dtype, np.float64)
        self.assertEqual(mesh.triangles.shape, (12, 3))
        self.assertEqual(mesh.normals.shape, (6, 3))
        self.assertEqual(mesh.polygon_of_triangle.max(), 5)
        self.assertEqual([len(rings) for rings in mesh.polygons], [1] * 6)
        self.assertEqual({len(rings[0]) for rings in mesh.polygons}, {4})

    def test_a_layer_outlives_its_scene(self):
        layers = colod.build({"a": box(10, 9, 5)}, **QUICK).buildings[0].layers
        self.assertAlmostEqual(volume(layers[0].mesh), 450, places=2)

    def test_other_numbers_and_orders_of_memory(self):
        points, triangles = box(10, 9, 5)
        mesh = np.asfortranarray(points.astype(np.float32)), triangles.astype(np.uint64).tolist()
        scene = colod.build({"a": mesh}, **QUICK)
        self.assertAlmostEqual(volume(scene.buildings[0].layers[0].mesh), 450, places=2)
        with self.assertRaisesRegex(ValueError, "shape"):
            colod.build({"a": np.zeros((4, 2))})
        with self.assertRaisesRegex(ValueError, "triangles"):
            colod.build({"a": ()})

    def test_files(self):
        told = []
        with tempfile.TemporaryDirectory() as folder:
            paths = [ASSETS / "house_00.obj", str(ASSETS / "house_01.obj")]
            scene = colod.build(paths, progress=lambda *args: told.append(args), format=["glb", "obj"], **QUICK)
            scene.write(pathlib.Path(folder) / "out")
            written = {
                str(p.relative_to(folder + "/out")): p.read_bytes()
                for p in pathlib.Path(folder, "out").rglob("*")
                if p.is_file()
            }
        files = scene.files()
        self.assertEqual(sorted(files), sorted(written))
        self.assertIn("buildings/house_00.glb", files)
        self.assertNotIn("tileset.json", files)
        for path in files:
            if path != "report.json":
                self.assertEqual(files[path], written[path], path)
        self.assertEqual(scene.report["parameters"]["ns"], 24)
        self.assertEqual(json.loads(files["report.json"])["buildings"][0]["name"], "house_00")
        self.assertEqual([t[1:] for t in told if t[1] == "layers"], [("layers", 1, 2), ("layers", 2, 2)])
        self.assertEqual(colod.build(ASSETS / "house_00.obj", **QUICK).buildings[0].source, str(ASSETS / "house_00.obj"))

    def test_errors(self):
        with self.assertRaises(colod.Error) as caught:
            colod.build("/nowhere/at/all")
        self.assertEqual((caught.exception.fault, caught.exception.item), ("input", "/nowhere/at/all"))
        with self.assertRaises(colod.Error) as caught:
            colod.build({"a": box(10, 9, 5)}, voxels=3)
        self.assertEqual((caught.exception.fault, caught.exception.item), ("usage", "voxels"))
        with self.assertRaises(ZeroDivisionError):
            colod.build({"a": box(10, 9, 5)}, progress=lambda *args: 1 / 0, **QUICK)

    def test_options(self):
        self.assertIn("voxels", colod.options()["ns"])
        self.assertTrue(set(QUICK) <= set(colod.options()))

    def test_two_scenes_at_once(self):
        meshes = [{"a": box(10, 9, 5), "b": box(12, 8, 6)}, {"c": box(9, 9, 9), "d": box(20, 8, 6)}]
        serial = [colod.build(m, **QUICK).files() for m in meshes]
        files = [None, None]

        def work(i):
            files[i] = colod.build(meshes[i], **QUICK).files()

        threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        for i in range(2):
            for path in serial[i]:
                if path != "report.json":
                    self.assertEqual(files[i][path], serial[i][path], path)

    def test_interrupt(self):
        # Shells let what runs in their background ignore the signal.
        program = (
            "import colod, signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
            f"print('go', flush=True); colod.build({str(ASSETS)!r}, ns=100)"
        )
        child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        child.stdout.readline()
        time.sleep(0.5)
        child.send_signal(signal.SIGINT)
        error = child.communicate(timeout=300)[1].decode()
        self.assertIn("KeyboardInterrupt", error)
        self.assertNotEqual(child.returncode, 0)

    def test_snippet_of_the_manual(self):
        text = (pathlib.Path(__file__).parents[2] / "docs" / "library.md").read_text()
        snippet = text.split("```python\n")[1].split("```")[0]
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(folder + "/houses")
            shutil.copy(ASSETS / "house_01.obj", folder + "/houses")
            before = os.getcwd()
            os.chdir(folder)
            try:
                exec(compile(snippet, "docs/library.md", "exec"), {})
                self.assertTrue(os.path.exists("out/tileset.json"))
            finally:
                os.chdir(before)


if __name__ == "__main__":
    unittest.main()
