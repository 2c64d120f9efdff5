"""The measures of tests/quality/patches.py, on sheets that are made by hand, and its tables on a short run."""
import json
import subprocess
import sys
import unittest

from support import PROGRAM, SOURCE, CliTest

sys.path.insert(0, str(SOURCE / "tests" / "quality"))
try:
    import numpy as np
    import patches
    import ply_data
    import rings
except ImportError:
    np = None


def plane(shake=0.15, side=60, seed=1):
    """Points one spacing apart, unevenly by `shake`; the right half is another patch."""
    x, y = [a.ravel().astype(float) for a in np.meshgrid(np.arange(side), np.arange(side), indexing="ij")]
    away = np.random.default_rng(seed).uniform(-shake, shake, (side * side, 2))
    points = np.stack([x + away[:, 0], y + away[:, 1], np.zeros(side * side)], 1)
    return ply_data.Ply(points, np.tile([0, 0, 1.0], (side * side, 1)), columns={"patch": (x >= side / 2).astype(np.int64)})


def ball(radius=40.0, count=20000):
    """A spiral of even points on a ball, the upper half another patch."""
    i = np.arange(count) + 0.5
    turn, z = i * np.pi * (3 - 5 ** 0.5), 1 - 2 * i / count
    normals = np.stack([np.cos(turn) * np.sqrt(1 - z * z), np.sin(turn) * np.sqrt(1 - z * z), z], 1)
    return ply_data.Ply(normals * radius, normals, columns={"patch": (normals[:, 0] > 0).astype(np.int64)})


@unittest.skipUnless(np, "numpy is absent")
class RepairedMail(CliTest):
    def test_rings_of_a_repaired_chainmail_are_whole(self):
        self.ok("make", "chainmail", "mail.ply")
        self.ok("patch", "mail.ply", "--size", "2x,2x", "-o", "sheet.ply")
        sheet = ply_data.load(self.path("sheet.ply"))
        x, y = sheet.points[:, 0], sheet.points[:, 1]
        away = np.maximum(np.maximum(45 - x, x - 80), np.maximum(50 - y, y - 80))
        kept = np.hstack([sheet.points, sheet.normals])[away > 0].astype(np.float32)
        np.savetxt(self.path("holed.xyz"), kept, fmt="%.9g")
        self.ok("patch", "mail.ply", "--keep", "holed.xyz", "--hole", "45,50,-9,80,80,40", "-o", "whole.ply", "--report", "r.json")
        counts = json.loads(self.read("r.json"))["counts"]
        whole = ply_data.load(self.path("whole.ply"))
        self.assertAlmostEqual(len(whole.points) / len(sheet.points), 1, delta=0.03)
        shares = rings.measure(whole, None, None)
        self.assertGreaterEqual(shares["whole"], 0.98, shares)
        self.assertGreaterEqual(shares["partners"], 0.95, shares)
        # What is far from the hole is as it was.
        far = kept[away[away > 0] > 2 * counts["overlap"] + 10 * counts["spacing"]]
        self.assertGreater(len(far), 20000)
        made = {tuple(row) for row in np.hstack([whole.points, whole.normals]).astype(np.float32).tolist()}
        self.assertTrue(all(tuple(row) in made for row in far.tolist()))


@unittest.skipUnless(np, "numpy is absent")
class PatchMeasures(CliTest):
    def test_one_surface_has_no_gap(self):
        for sheet in (plane(), ball()):
            result = patches.borders(sheet, sheet)
            self.assertGreater(result["pairs"], 100)
            self.assertEqual(result["patches"], 2)
            for name in ("gap", "gap_inside", "gap_worst"):
                self.assertLess(result[name], 1e-6, name)
            self.assertAlmostEqual(result["jump"], 1, delta=0.03)
            self.assertAlmostEqual(result["spacing_at_borders"], 1, delta=0.03)
            self.assertEqual(result["spacing"], result["spacing_of_exemplar"])

    def test_a_step_is_the_gap(self):
        for step in (0.02, 0.2):
            sheet = plane(shake=0)
            sheet.points[sheet.columns["patch"] == 1, 2] += step
            result = patches.borders(sheet)
            self.assertAlmostEqual(result["gap"], step, places=6)
            self.assertAlmostEqual(result["gap_worst"], step, places=6)
            self.assertLess(result["gap_inside"], 1e-9)
        round_one = ball()
        right = round_one.columns["patch"] == 1
        round_one.points[right] += 0.1 * round_one.normals[right]
        self.assertAlmostEqual(patches.borders(round_one)["gap"] * rings.spacing(round_one.points), 0.1, delta=0.002)

    def test_a_wedge_is_a_jump_of_normals(self):
        flat = plane(shake=0)
        flat.normals[flat.columns["patch"] == 1] = [np.sin(0.1), 0, np.cos(0.1)]
        self.assertEqual(patches.borders(flat)["jump"], float("inf"))
        bent = ball()
        right = bent.columns["patch"] == 1
        turned = bent.normals[right] + [0.05, 0, 0]
        bent.normals[right] = turned / np.linalg.norm(turned, axis=1)[:, None]
        self.assertGreater(patches.borders(bent)["jump"], 1.5)

    def test_an_empty_strip_and_a_crowd_are_uneven(self):
        for shift, wider in ((1.2, True), (-0.7, False)):
            sheet = plane()
            sheet.points[sheet.columns["patch"] == 1, 0] += shift
            result = patches.borders(sheet, plane())
            self.assertEqual(result["spacing_at_borders"] > 1, wider, result)
            self.assertGreater(abs(result["spacing_at_borders"] - 1), 0.05)
            self.assertGreater(result["spacing"], result["spacing_of_exemplar"])

    def test_sheets_back_to_back_do_not_meet(self):
        top, bottom = plane(), plane(seed=2)
        bottom.points[:, 2] -= 1
        both = ply_data.Ply(np.concatenate([top.points, bottom.points]), np.concatenate([top.normals, -bottom.normals]),
                            columns={"patch": np.concatenate([top.columns["patch"], top.columns["patch"]])})
        self.assertLess(patches.borders(both)["gap"], 1e-6)

    def test_no_scipy_gives_the_same(self):
        sheet, tree = plane(side=30), patches.cKDTree
        with_tree = patches.borders(sheet)
        patches.cKDTree = None
        try:
            self.assertEqual({k: round(v, 9) for k, v in patches.borders(sheet).items()}, {k: round(v, 9) for k, v in with_tree.items()})
        finally:
            patches.cKDTree = tree

    def test_one_patch_and_nothing_to_measure(self):
        one = plane()
        one.columns["patch"][:] = 7
        self.assertNotIn("gap", patches.borders(one))
        for lack in (ply_data.Ply(one.points, one.normals), ply_data.Ply(one.points, columns=one.columns)):
            with self.assertRaises(ValueError):
                patches.borders(lack)

    def test_ply_files_come_back(self):
        sheet = plane(side=8)
        sheet.columns["height"] = np.linspace(0, 1, 64)
        sheet.comments = ["vdbsynth:domain 0,0,-1,7,7,1"]
        sheet.triangles = np.array([[0, 1, 8], [1, 9, 8]])
        ply_data.write_ply(self.path("s.ply"), sheet)
        again = ply_data.load(self.path("s.ply"))
        self.assertTrue(np.allclose(again.points, sheet.points, atol=1e-6))
        self.assertTrue((again.columns["patch"] == sheet.columns["patch"]).all())
        self.assertTrue(np.allclose(again.columns["height"], sheet.columns["height"]))
        self.assertTrue((again.triangles == sheet.triangles).all())
        self.assertTrue((again.domain() == [[0, 0, -1], [7, 7, 1]]).all())
        self.assertIsNone(again.comment("vdbsynth:plane"))
        self.assertEqual(len(again.part(again.points[:, 0] < 0.5).triangles), 0)
        self.ok("make", "weave", "w.obj", "--resolution", 24)
        self.assertGreater(len(ply_data.load(self.path("w.obj"), PROGRAM).triangles), 100)
        self.write("no.ply", "ply\nformat ascii 1.0\nend_header\n")
        with self.assertRaises(ValueError):
            ply_data.load(self.path("no.ply"))
        with self.assertRaises(RuntimeError):
            ply_data.load(self.path("none.obj"), PROGRAM)

    def test_a_table_of_a_short_run(self):
        if self.run_tool("patch", "--help").returncode != 0:
            self.skipTest("this build has no command patch")
        build = PROGRAM.rsplit("/tools/", 1)[0]
        done = subprocess.run([sys.executable, str(SOURCE / "tests" / "quality" / "patches.py"), build, "borders", "seconds", "--kind", "bumps", "--size", "2x,2x"],
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        rows = [line for line in done.stdout.splitlines() if line.startswith("| bumps")]
        self.assertEqual(len(rows), 2, done.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
