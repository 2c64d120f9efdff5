"""tests/quality/rings.py: it finds every ring of `make chainmail` whole and linked, and sees those that are broken."""
import json
import subprocess
import sys
import unittest

from support import PROGRAM, SOURCE, CliTest

sys.path.insert(0, str(SOURCE / "tests" / "quality"))
try:
    import numpy as np
    import ply_data
    import rings
except ImportError:
    np = None


def circle(centre, axis, radius):
    u, v = rings.across(np.array(axis, float))
    turn = np.arange(65) * 2 * np.pi / 64
    return np.array(centre, float) + radius * (np.cos(turn)[:, None] * u + np.sin(turn)[:, None] * v)


def torus(centre, axis, radius, tube, along=120, around=12):
    """Points, normals and triangles."""
    axis = np.array(axis, float) / np.linalg.norm(axis)
    u, v = rings.across(axis)
    s, t = [a.ravel() for a in np.meshgrid(np.arange(along) * 2 * np.pi / along, np.arange(around) * 2 * np.pi / around, indexing="ij")]
    out = np.cos(s)[:, None] * u + np.sin(s)[:, None] * v
    normal = np.cos(t)[:, None] * out + np.sin(t)[:, None] * axis
    number = np.arange(along * around).reshape(along, around)
    a, b = number, np.roll(number, -1, 0)
    c, d = np.roll(b, -1, 1), np.roll(a, -1, 1)
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return np.array(centre, float) + radius * out + tube * normal, normal, faces


def sheet(columns, rows, mesh=True, along=120):
    """A lattice as that of `make chainmail`, cells of side 1, nothing cut."""
    parts, first = [], 0
    for i in range(columns):
        for j in range(rows):
            for centre, axis, radius in (((i, j, 0), (0, 0, 1), 0.4), ((i + 0.5, j, 0), (0, 1, 0), 0.31), ((i, j + 0.5, 0), (1, 0, 0), 0.31)):
                points, normals, faces = torus(centre, axis, radius, 0.05, along, along // 10)
                parts.append((points, normals, faces + first))
                first += len(points)
    points, normals, faces = (np.concatenate([part[k] for part in parts]) for k in range(3))
    return ply_data.Ply(points, normals, faces if mesh else ())


def nearest(found, place):
    return min(found, key=lambda ring: np.linalg.norm(ring.centre - place))


@unittest.skipUnless(np, "numpy is absent")
class Rings(CliTest):
    def measured(self, name, *words):
        done = subprocess.run([sys.executable, str(SOURCE / "tests" / "quality" / "rings.py"), self.path(name), "--tool", PROGRAM, "--json", *words],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def all_whole(self, result, least):
        self.assertGreaterEqual(result["counted"], least)
        for name in ("closed", "single", "whole", "partners"):
            self.assertEqual(result[name], 1, result)

    def test_a_made_chainmail_has_no_fault(self):
        for size, words, least in (("64,64,22", (), 2), ("128,96,22", ("--seed", 5), 20), ("96,96,40", ("--feature", 40), 2)):
            self.ok("make", "chainmail", "m.vdb", "-o", "m.ply", "--size", size, *words)
            for name in ("m.vdb", "m.ply"):
                self.all_whole(self.measured(name), least)

    def test_a_third_is_flat_and_links_are_as_many_as_the_lattice_has(self):
        for mesh in (True, False):
            result = rings.measure(sheet(5, 4, mesh))
            # Every upright ring is linked to two flat ones, but those beyond the last row or column to one.
            self.assertEqual((result["components"], result["whole_rings"], result["links"]), (60, 60, 4 * 20 - 5 - 4))
            self.all_whole(result, 10)
        inner = rings.measure(sheet(9, 9))
        self.assertAlmostEqual(inner["flat"], 1 / 3, delta=0.04)

    def test_a_sleeve_has_no_ends_around_its_axis(self):
        flat = sheet(12, 5)
        turn = flat.points[:, 0] * 2 * np.pi / 12
        radius = 12 / (2 * np.pi) + flat.points[:, 2]
        flat.points = np.stack([radius * np.cos(turn), radius * np.sin(turn), flat.points[:, 1]], 1)
        result = rings.measure(flat, around=2)
        self.all_whole(result, 12 * 3 * 2)
        self.assertAlmostEqual(result["flat"], 1 / 3, delta=0.08)


@unittest.skipUnless(np, "numpy is absent")
class BrokenRings(unittest.TestCase):
    """One ring of 5 x 5 cells is broken; 33 rings are farther from the ends than the border."""

    def setUp(self):
        self.flat, self.upright = np.array([2, 2, 0.0]), np.array([2.5, 2, 0.0])

    def both(self, along=120):
        return (sheet(5, 5, mesh, along) for mesh in (True, False))

    def without(self, ply, removed):
        return ply.part(~removed(ply.points))

    def near(self, points, centre, reach):
        """The points of one flat ring, within `reach` of its tube's middle."""
        away = points - centre
        return np.hypot(np.hypot(away[:, 0], away[:, 1]) - 0.4, away[:, 2]) < reach

    def test_a_ring_cut_open(self):
        for ply in self.both(along=240):
            for degrees, opens in ((12, True), (2, False)):
                def removed(points, degrees=degrees):
                    turn = np.degrees(np.arctan2(points[:, 1] - 2, points[:, 0] - 2))
                    return self.near(points, self.flat, 0.06) & (np.abs(turn - 45) < degrees / 2)
                result = rings.measure(self.without(ply, removed))
                counted = result["counted"]
                self.assertAlmostEqual(counted, 33, delta=1)
                self.assertEqual(result["closed"] < 1, opens, (degrees, result))
                if opens:
                    self.assertAlmostEqual(result["closed"], 1 - 1 / counted, delta=0.02)
                    self.assertAlmostEqual(result["whole"], 1 - 1 / counted, delta=0.02)

    def test_two_rings_fused(self):
        for ply in self.both():
            before = rings.measure(ply)
            a = np.argmin(np.linalg.norm(ply.points - [2.4, 2, 0.05], axis=1))
            b = np.argmin(np.linalg.norm(ply.points - [2.19, 2, 0.05], axis=1))
            if len(ply.triangles):
                ply.triangles = np.concatenate([ply.triangles, [[a, b, b]]])
            else:
                steps = np.linspace(0, 1, 40)[:, None]
                ply.points = np.concatenate([ply.points, ply.points[a] * (1 - steps) + ply.points[b] * steps])
                ply.normals = np.concatenate([ply.normals, ply.normals[a] * (1 - steps) + ply.normals[b] * steps])
            result = rings.measure(ply)
            self.assertEqual(result["components"], before["components"] - 1)
            self.assertEqual(result["whole_rings"], before["whole_rings"] - 2)
            self.assertAlmostEqual(result["single"], 1 - 2 / result["counted"], delta=0.03)
            self.assertLess(result["partners"], result["single"])

    def test_a_ring_removed(self):
        for ply in self.both():
            before = rings.measure(ply)
            result = rings.measure(self.without(ply, lambda points: self.near(points, self.flat, 0.06)))
            self.assertEqual(result["components"], before["components"] - 1)
            self.assertEqual(result["links"], before["links"] - 4)
            self.assertEqual(result["whole"], 1)
            # Its four upright neighbours have one partner left.
            self.assertAlmostEqual(result["partners"], 1 - 4 / result["counted"], delta=0.001)

    def test_a_ring_pulled_out_is_whole_without_partners(self):
        for ply in self.both():
            ply.points[self.near(ply.points, self.flat, 0.06)] += [0, 0, 0.5]
            result = rings.measure(ply)
            self.assertEqual(result["whole"], 1)
            self.assertAlmostEqual(result["partners"], 1 - 5 / result["counted"], delta=0.001)

    def test_a_blob_is_no_ring(self):
        points = np.random.default_rng(1).normal(size=(3000, 3))
        points *= 0.4 / np.linalg.norm(points, axis=1)[:, None]
        ply = sheet(5, 5, mesh=False)
        ball = ply_data.Ply(np.concatenate([ply.points, points + self.flat + [0.5, 0.5, 0]]), np.concatenate([ply.normals, points / 0.4]))
        result = rings.measure(ball)
        self.assertLess(result["single"], 1)
        self.assertLess(result["whole"], 1)

    def test_nothing_that_closes(self):
        result = rings.measure(ply_data.Ply(np.random.default_rng(1).normal(size=(500, 3)), np.tile([0, 0, 1.0], (500, 1))))
        self.assertEqual((result["whole"], result["partners"]), (0, 0))
        with self.assertRaises(ValueError):
            rings.measure(ply_data.Ply(np.zeros((5, 3))))


@unittest.skipUnless(np, "numpy is absent")
class RingNumbers(unittest.TestCase):
    def test_gauss_integral_of_circles(self):
        flat = circle((0, 0, 0), (0, 0, 1), 0.4)
        for centre, axis, radius, wanted in (((0.5, 0, 0), (0, 1, 0), 0.31, 1), ((0, 0.5, 0), (1, 0, 0), 0.31, 1), ((1, 0, 0), (0, 0, 1), 0.4, 0),
                                             ((0.5, 0, 0.5), (0, 1, 0), 0.31, 0), ((0, 0, 0.2), (0, 0, 1), 0.4, 0), ((0.2, 0, 0), (0, 1, 0.3), 0.4, 1)):
            self.assertAlmostEqual(abs(rings.linking(flat, circle(centre, axis, radius))), wanted, delta=0.01)

    def test_a_circle_is_fitted_to_a_torus_and_to_an_arc_of_it(self):
        points, _, _ = torus((1, 2, 3), (1, 2, 2), 4, 0.5)
        turn = np.arctan2((points - [1, 2, 3]) @ rings.across(np.array([1, 2, 2]) / 3)[0], (points - [1, 2, 3]) @ rings.across(np.array([1, 2, 2]) / 3)[1])
        for part in (points, points[np.abs(turn) < 2]):
            centre, axis, radius, tube, scatter = rings.fitted(part)
            self.assertTrue(np.allclose(centre, [1, 2, 3], atol=1e-3))
            self.assertAlmostEqual(abs(axis @ [1, 2, 2]) / 3, 1, places=6)
            self.assertAlmostEqual(radius, 4, places=3)
            self.assertAlmostEqual(tube, 0.5, places=3)
            self.assertLess(scatter, 1e-3)

    def test_the_gap_around_a_circle(self):
        def gap(*angles):
            turn = np.radians(np.array(angles, float))
            corners = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], -1)
            u = rings.across(np.array([0, 0, 1.0]))
            return rings.angular_gap(corners[..., 0, None] * u[0] + corners[..., 1, None] * u[1], np.zeros(3), np.array([0, 0, 1.0]))
        self.assertAlmostEqual(gap([0], [90], [180], [270]), 90)
        self.assertAlmostEqual(gap([10], [90], [200], [340]), 140)
        self.assertAlmostEqual(gap([0, 120], [110, 240], [230, 355]), 5)
        self.assertAlmostEqual(gap([350, 10], [5, 170], [171, 349]), 1)
        self.assertAlmostEqual(gap([0, 170], [160, 300], [290, 20]), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
