"""Every method through the Python module, each with a property that its result must have."""
import os
import unittest

import numpy
import vdbsynth

from module_test import ModuleTest, ball, distances


def wave(side=32, period=8.0):
    """A picture of heights that tiles, 0 to 1."""
    row = numpy.sin(numpy.arange(side) * 2 * numpy.pi / period) * 0.5 + 0.5
    return numpy.tile(row.astype("float32"), (side, 1))


def extent(points):
    return points.max(0) - points.min(0)


class Synthesis(ModuleTest):
    def test_make(self):
        self.assertIn("chainmail", vdbsynth.exemplar_kinds())
        self.assertIn("grooves", vdbsynth.pair_kinds())
        model = vdbsynth.make("weave", size=(32, 24, 16), feature=8.0, voxelSize=0.5, seed=3)
        self.assertEqual((model.domain, model.voxel_size), (((0, 0, 0), (31, 23, 15)), 0.5))
        self.assertNotEqual(model.hash, vdbsynth.make("weave", size=(32, 24, 16), feature=8.0, voxelSize=0.5, seed=4).hash)
        self.fails("InvalidOption", "wool", vdbsynth.make, "wool")
        with self.assertRaisesRegex(TypeError, "make: unknown keyword kinds"):
            vdbsynth.make("weave", kinds=1)

    def test_synth_of_two_exemplars_by_a_map(self):
        first, second = vdbsynth.make("grid", resolution=32), vdbsynth.make("balls", resolution=32)
        side = numpy.zeros((64, 32, 32), "int32")
        side[32:] = 1
        result = vdbsynth.synth([first, second], size="2x,1x,1x", exemplarMap=vdbsynth.Grid.from_numpy(side, background=-1))
        sources = result.map.sources(result.model)
        left, right = sources["voxel"][:, 0] < 24, sources["voxel"][:, 0] >= 40
        self.assertGreater((sources["exemplar"][left] == 0).mean(), 0.95)
        self.assertGreater((sources["exemplar"][right] == 1).mean(), 0.95)

    def test_a_source_is_where_the_value_comes_from(self):
        exemplar = vdbsynth.make("grid", resolution=32)
        result = vdbsynth.synth(exemplar, size="2x,1x,1x", seed=2)
        sources = result.map.sources(result.model)
        self.assertEqual(sources["position"].shape, (len(sources["voxel"]), 3))
        low = numpy.array(result.model.box[0])
        own = numpy.array(exemplar.box[0])
        inner = (numpy.abs(sources["voxel"] - [32, 16, 16]) < [28, 12, 12]).all(1)
        to = tuple((sources["voxel"][inner] - low).T)
        at = tuple((numpy.rint(sources["position"][inner]).astype(int) - own).T)
        error = numpy.abs(result.model.to_numpy()[to] - exemplar.to_numpy()[at])
        self.assertLess(error.mean(), 0.3)

    def test_attributes_follow(self):
        exemplar = vdbsynth.make("grid", resolution=32)
        low, high = exemplar.box
        height = numpy.broadcast_to(numpy.arange(low[2], high[2] + 1.0) + 100, exemplar.to_numpy().shape).astype("float32")
        marked = exemplar.with_attributes([vdbsynth.Grid.from_numpy(height, origin=low, name="height")])
        result = vdbsynth.synth(marked, size="2x,1x,1x")
        self.assertEqual([grid.name for grid in result.model.attributes], ["height"])
        # Along an axis that keeps its length a source keeps its place.
        grid = result.model.attributes[0]
        box = result.model.domain
        values, active = grid.to_numpy(box), grid.active(box)
        numpy.testing.assert_array_equal(values[active], numpy.broadcast_to(numpy.arange(32) + 100.0, active.shape)[active])

    def test_fill(self):
        exemplar = vdbsynth.make("grid", resolution=48)
        box = ((16, 16, 16), (31, 31, 31))
        cut = exemplar.to_numpy(exemplar.box).copy()
        low = exemplar.box[0]
        part = tuple(slice(a - l, b - l + 1) for a, b, l in zip(*box, low))
        cut[part] = 3.0
        holed = vdbsynth.LevelSet.from_numpy(cut, 1.0, low).with_domain(exemplar.domain)
        result = vdbsynth.fill(holed, box, exemplar)
        inside = lambda model: (model.to_numpy(box) < 0).mean()
        self.assertEqual(inside(holed), 0)
        self.assertAlmostEqual(inside(result.model), inside(exemplar), delta=0.15)
        self.assertEqual(result.map.method, "fill")
        far = ((0, 0, 0), (47, 47, 8))
        numpy.testing.assert_array_equal(result.model.to_numpy(far), holed.to_numpy(far))
        self.assertEqual(vdbsynth.repeat(result.map, [exemplar, holed]).hash, result.model.hash)
        self.fails("InvalidOption", "`hole` all: must be one of auto", vdbsynth.fill, holed, "all")
        self.fails("Unusable", ".", vdbsynth.fill, holed, "auto")

    def test_analogy(self):
        plain, textured = vdbsynth.make_pair("grooves", resolution=40)
        target = ball(size=41, voxel=1.0, radius=16.0)
        result = vdbsynth.analogy([(plain, textured)], target, direction="axis:z", keepDirections=True, sweeps=1)
        self.assertEqual(result.map.method, "analogy")
        self.assertEqual(result.directions.type, "vec3s")
        self.assertEqual(len(result.levels), 2)
        self.assertEqual(result.singularities.shape[1], 3)
        self.assertLess(abs(extent(result.model.to_mesh().points).max() - 32), 8)
        self.assertNotEqual(result.model.hash, target.hash)
        # Strength 0 leaves the target; a mask is a grid over it.
        self.assertLess(vdbsynth.compare(target, vdbsynth.analogy((plain, textured), target, strength=0.0, sweeps=1).model)
                        .distances[0].surface.hausdorff, 0.2)
        again = vdbsynth.repeat(result.map, [textured, target])
        self.assertEqual(again.hash, result.model.hash)
        with self.assertRaisesRegex(TypeError, "`pairs`: must be a pair of LevelSet"):
            vdbsynth.analogy(plain, target)

    def test_filter_analogy(self):
        rng = numpy.random.default_rng(1)
        before = rng.random((24, 24, 24)).astype("float32") + 1
        target = rng.random((20, 20, 20)).astype("float32") + 1
        twice = lambda values: vdbsynth.Grid.from_numpy(values, name="density")
        result = vdbsynth.filter_analogy((twice(before), twice(before * 2 + 1)), twice(target))
        error = numpy.abs(result.grid.to_numpy(((0, 0, 0), (19, 19, 19))) - (target * 2 + 1))[4:-4, 4:-4, 4:-4]
        self.assertLess(error.mean(), 0.05 * numpy.abs(target + 1).mean())
        self.assertLess(result.stats.affineError, 0.1 * result.stats.change)
        with self.assertRaisesRegex(TypeError, "a grid of floats"):
            vdbsynth.filter_analogy((twice(before), twice((before > 1))), twice(target))

    def test_match_crop_and_pose(self):
        model = vdbsynth.make("foam", resolution=48)
        found = vdbsynth.match(model, model, block=12, at=(10, 11, 12), count=3).matches
        self.assertEqual((found[0].position, found[0].cost), ((10, 11, 12), 0.0))
        self.assertLessEqual(found[1].cost, found[2].cost)
        part = vdbsynth.crop(model, ((8, 8, 8), (39, 31, 23)))
        self.assertEqual((part.domain, part.domainRecorded), (((8, 8, 8), (39, 31, 23)), True))
        mesh = ball(size=33, voxel=1.0, radius=12.0).to_mesh()
        moved = vdbsynth.Mesh(mesh.points + numpy.float32([5, 0, 0]), mesh.triangles, mesh.quads)
        rest, posed = (vdbsynth.LevelSet.from_mesh(m, 1.0, keepSource=True) for m in (mesh, moved))
        self.assertEqual(rest.source.points.shape, mesh.points.shape)
        result = vdbsynth.pose(rest, rest, posed)
        self.assertLess(vdbsynth.compare(posed, result).distances[0].surface.mean, 0.1)

    def test_minimal_wall(self):
        plate = vdbsynth.LevelSet.from_numpy(numpy.broadcast_to(numpy.abs(numpy.arange(16.0) - 7.5) - 2, (32, 32, 16)).astype("float32") * 0.5, 0.5, domainRecorded=True)
        thickness, place = vdbsynth.minimal_wall(plate)
        self.assertAlmostEqual(thickness, 2.0, delta=0.1)
        self.assertEqual(len(place), 3)


class Textures(ModuleTest):
    def picture(self):
        rows, columns = numpy.mgrid[0:32, 0:32]
        return numpy.stack([rows % 8 < 4, columns % 8 < 4, rows * 0], axis=2).astype("float32")

    def test_targets_of_every_kind(self):
        model = ball(size=25, voxel=0.5, radius=4.0)
        mesh, cloud = model.to_mesh(), model.to_points()
        sample = vdbsynth.TextureSample(self.picture(), tileable=True)
        self.assertEqual((sample.image.shape, sample.tileable, sample.maps), ((32, 32, 3), True, {"Cd": (0, 3)}))
        numpy.testing.assert_array_equal(sample.image, self.picture())
        for target, kind, count in [(model, "levelset", None), (mesh, "mesh", len(mesh.points)), (cloud, "points", len(cloud.points))]:
            made = vdbsynth.texture(target, sample)
            self.assertEqual(made.target.kind, kind)
            if count:
                self.assertEqual(len(made.target.points), count)
            values = made.attributes["Cd"]
            self.assertEqual(values.shape, (len(made.target.points), 3))
            self.assertTrue(((values >= 0) & (values <= 1)).all())
            self.assertLess(values[:, 2].max(), 0.01)
            self.assertGreater(values[:, 0].std(), 0.2)
            numpy.testing.assert_allclose(numpy.linalg.norm(made.tangent, axis=1), 1, atol=1e-4)
        made.write(self.path("p.ply"))
        again = vdbsynth.repeat_texture(self.path("p.ply"), vdbsynth.TextureSample(1 - self.picture(), tileable=True))
        numpy.testing.assert_allclose(again.attributes["Cd"][:, :2], 1 - values[:, :2], atol=0.02)

    def test_a_file_gives_what_memory_gives(self):
        mesh = ball(size=25, voxel=0.5, radius=4.0).to_mesh()
        mesh.write(self.path("m.off"))
        sample = vdbsynth.TextureSample(self.picture(), tileable=True)
        read = vdbsynth.read_target(self.path("m.off"))
        self.assertEqual(read.kind, "mesh")
        numpy.testing.assert_array_equal(vdbsynth.texture(read, sample, seed=3).coordinate, vdbsynth.texture(mesh, sample, seed=3).coordinate)

    def test_regions_and_maps(self):
        cloud = ball().to_points()
        height = wave()[:, :, None]
        samples = [vdbsynth.TextureSample(numpy.full((16, 16, 3), level, "float32"), maps={"height": numpy.full((16, 16), 1 - level, "float32")}) for level in (0.25, 0.75)]
        upper = vdbsynth.LevelSet.from_numpy(distances((30, 30, 30), 1.0, 6.0, (6, 6, 12)))
        made = vdbsynth.texture(cloud, samples, labels=upper)
        inside = numpy.linalg.norm(made.target.site - [6, 6, 12], axis=1) < 5
        outside = numpy.linalg.norm(made.target.site - [6, 6, 12], axis=1) > 7
        self.assertTrue((made.sample[inside] == 1).all() and (made.sample[outside] == 0).all())
        numpy.testing.assert_allclose(made.attributes["height"], 1 - made.attributes["Cd"][:, 0], atol=1e-5)
        labels = numpy.arange(len(made.target.site)) % 2
        numpy.testing.assert_array_equal(vdbsynth.texture(cloud, samples, labels=labels).sample, labels)
        self.fails("ShapeMismatch", "`labels`: holds 3 numbers", vdbsynth.texture, cloud, samples, labels=[0, 1, 0])
        self.fails("InvalidOption", "`labels` 2", vdbsynth.texture, cloud, samples, labels=labels * 2)
        moved = made.displace("height", 2.0)
        step = numpy.linalg.norm(moved.points - made.points, axis=1)
        numpy.testing.assert_allclose(step, 2 * made.attributes["height"], atol=0.01)
        self.fails("ShapeMismatch", "height: must have the size of its colour", vdbsynth.TextureSample, self.picture(), {"height": height[:8]})

    def test_outputs(self):
        made = vdbsynth.texture(ball(), vdbsynth.TextureSample(self.picture()))
        made.write([self.path("t.glb"), self.path("t.ply"), self.path("t.vdb"), self.path("t.obj")])
        self.assertEqual(len(os.listdir(self.folder)), 4)
        self.assertIn("Cd", {one["name"] for one in vdbsynth.grids(self.path("t.vdb"))})
        self.fails("Unusable", ".", made.write, self.path("t.png"), bake=True)


class Reliefs(ModuleTest):
    def bumpy(self):
        """A slab with waves of two voxels on it."""
        x = numpy.arange(64.0)
        surface = 16 + 2 * numpy.sin(x * 2 * numpy.pi / 10)[:, None] * numpy.ones(64)
        z = numpy.arange(32.0)
        return vdbsynth.LevelSet.from_numpy((z[None, None, :] - surface[:, :, None]).astype("float32"), domainRecorded=True)

    def test_extract(self):
        result = vdbsynth.relief_extract(self.bumpy(), baseRadius=5.0, strength=0.0)
        self.assertAlmostEqual(result.statistics.sq, 2 / 2**0.5, delta=0.25)
        self.assertEqual(result.radius, 5.0)
        self.assertEqual(result.relief.type, "float")
        self.assertLess(vdbsynth.compare(result.base, result.surface).distances[0].surface.mean, 0.2)
        self.assertEqual(result.scanCounts.solids, 1)
        result.write([self.path("r.vdb"), self.path("r.png"), self.path("r.obj")])
        self.assertIn("relief", {one["name"] for one in vdbsynth.grids(self.path("r.vdb"))})
        self.assertIsNone(vdbsynth.relief_extract(self.bumpy(), baseRadius=5.0).surface)

    def test_a_scan_and_a_picture(self):
        target = ball(size=49, voxel=1.0, radius=18.0)
        for sample, height in [(self.bumpy(), 4.0), (vdbsynth.Heights(wave(), height=3.0, tileable=True), 3.0)]:
            result = vdbsynth.relief(sample, target, baseRadius=5.0) if height == 4.0 else vdbsynth.relief(sample, target)
            far = vdbsynth.compare(target, result.model).distances[0].surface
            self.assertGreater(far.hausdorff, height / 5)
            self.assertLess(far.hausdorff, height * 1.5)
            self.assertIn("source_u", [grid.name for grid in result.sources])
        none = vdbsynth.relief(sample, target, strength=0.0)
        self.assertLess(vdbsynth.compare(target, none.model).distances[0].surface.hausdorff, 0.05)
        self.fails("InvalidOption", "`heights` .*: must be from 0", vdbsynth.Heights, wave() * 2)
        self.fails("InvalidOption", "`labels`: missing", vdbsynth.relief, [sample, sample], target)
        two = vdbsynth.relief([sample, vdbsynth.Heights(wave(), height=1.0)], target, labels="auto")
        self.assertNotEqual(two.model.hash, result.model.hash)

    def test_masks(self):
        target = ball(size=49, voxel=1.0, radius=18.0)
        sample = vdbsynth.Heights(wave(), height=3.0, tileable=True)
        half = vdbsynth.LevelSet.from_numpy(distances((60, 60, 60), 1.0, 14.0, (24, 24, 44)))
        masked = vdbsynth.relief(sample, target, maskModel=half)
        below = ((0, 0, 0), (48, 48, 20))
        numpy.testing.assert_array_equal(masked.model.to_numpy(below), target.to_numpy(below))
        self.assertGreater(masked.unchanged, 0.3)
        self.assertNotEqual(masked.model.hash, target.hash)

    def test_bake(self):
        # A sheet of two triangles over its own coordinates, and a plate with waves.
        target = vdbsynth.LevelSet.from_numpy((numpy.abs(numpy.arange(24.0) - 12) - 6)[None, None, :].repeat(40, 0).repeat(40, 1).astype("float32"), domainRecorded=True)
        result = vdbsynth.relief(vdbsynth.Heights(wave(), height=2.0, tileable=True), target)
        points = [[0, 0, 18], [39, 0, 18], [39, 39, 18], [0, 39, 18]]
        sheet = vdbsynth.Mesh(points, [[0, 1, 2], [0, 2, 3]], attributes={"uv": [[0, 0], [1, 0], [1, 1], [0, 1]]})
        result.bake(sheet, self.path("d.exr"), size=64, reach=3.0)
        heights = vdbsynth.read_samples(self.path("d.exr"))[0].image[8:56, 8:56, 0]
        self.assertGreater(numpy.ptp(heights), 0.5)
        self.assertLess(numpy.abs(heights).max(), 2.5)


class Patches(ModuleTest):
    def mail(self):
        cloud, comments = vdbsynth.make_points("bumps", resolution=48, feature=12.0)
        self.assertTrue(any(line.startswith("vdbsynth:domain") for line in comments))
        cloud.write(self.path("mail.ply"), comments)
        return vdbsynth.read_patch_source(self.path("mail.ply"))

    def test_a_sheet_its_map_and_its_solid(self):
        source = self.mail()
        self.assertTrue(source.recorded)
        self.assertEqual(source.count, len(vdbsynth.read_points(self.path("mail.ply")).points))
        sheet = vdbsynth.patch(source, width=1.5 * source.size[0], depth=source.size[1], seed=2)
        self.assertEqual((sheet.width, sheet.depth), (1.5 * source.size[0], source.size[1]))
        cloud = sheet.points()
        numpy.testing.assert_allclose(extent(cloud.points)[:2], [sheet.width, sheet.depth], rtol=0.05)
        numpy.testing.assert_allclose(numpy.linalg.norm(cloud.normals, axis=1), 1, atol=1e-3)
        self.assertEqual(cloud.attributes["patch"].max(), sheet.patches - 1)
        solid = sheet.level_set()
        self.assertTrue(solid.domainRecorded)
        numpy.testing.assert_allclose((numpy.array(solid.domain[1]) - solid.domain[0] + 1)[:2] * solid.voxel_size, [sheet.width, sheet.depth], rtol=0.05)
        vdbsynth.write_grids(self.path("map.vdb"), sheet.map_grids())
        again = vdbsynth.repeat_patch(self.path("map.vdb"), self.path("mail.ply"))
        numpy.testing.assert_array_equal(again.points().points, cloud.points)
        self.fails("InvalidOption", "`width` 0.0: must be above 0", vdbsynth.patch, source)
        self.fails("InvalidOption", "`tolerance`", vdbsynth.patch, source, width=9.0, depth=9.0, tolerance=-1.0)

    def test_the_papers_method_takes_dicts(self):
        source = self.mail()
        sheet = vdbsynth.patch(source, width=60.0, depth=40.0, method="paper", limits={"position": 5.0}, rounds=1,
                               weights={"normal": 2.0, "variation": 9.0, "length": 5.0, "direction": 5.0})
        self.assertGreater(sheet.patches, 3)
        with self.assertRaisesRegex(TypeError, "limits: unknown keyword places"):
            vdbsynth.patch(source, width=60.0, depth=40.0, limits={"places": 5.0})

    def test_over_a_model(self):
        source = self.mail()
        ball(size=49, voxel=2.0, radius=40.0).write(self.path("b.vdb"))
        model = vdbsynth.read_onto_model(self.path("b.vdb"), source)
        over = vdbsynth.patch_onto(source, model, seed=1)
        cloud = over.points()
        away = numpy.linalg.norm(cloud.points + numpy.array(cloud.origin) - 48, axis=1) - 40
        self.assertLess(numpy.abs(away).max(), source.size[2])
        solid = over.level_set(voxel_size=2.0, with_model=model)
        self.assertGreater(extent(solid.to_mesh().points).max(), 79)
        vdbsynth.write_grids(self.path("map.vdb"), over.map_grids())
        again = vdbsynth.repeat_patch(self.path("map.vdb"), self.path("mail.ply"))
        numpy.testing.assert_array_equal(again.points().points, cloud.points)

    def test_a_hole(self):
        source = self.mail()
        vdbsynth.patch(source, width=2 * source.size[0], depth=1.5 * source.size[1]).points().write(self.path("sheet.ply"))
        sheet = vdbsynth.read_patch_source(self.path("sheet.ply"), whole=True)
        before = vdbsynth.read_points(self.path("sheet.ply")).points
        hole = ((40, 24, -50), (56, 40, 50))
        made = vdbsynth.patch_hole(sheet, hole, source)
        self.assertGreater(made.removed, 50)
        after = made.points().points
        kept = set(map(tuple, after[:made.kept]))
        numpy.testing.assert_array_equal(after[:made.kept], [point for point in before if tuple(point) in kept])
        within = (after[:, 0] > 42) & (after[:, 0] < 54) & (after[:, 1] > 26) & (after[:, 1] < 38)
        self.assertGreater(within.sum(), 50)
        self.assertGreater(made.level_set().active_voxels, 1000)


class Measures(ModuleTest):
    def test_compare(self):
        model = vdbsynth.make("balls", resolution=48, seed=1)
        result = vdbsynth.synth(model, size="2x,1x,1x", seed=4)
        found = vdbsynth.compare(model, [result.model, model], names=["e", "more", "same"], maps=[result.map, None])
        self.assertEqual([found.reference.name] + [m.name for m in found.others], ["e", "more", "same"])
        fraction = {s.name: s for s in found.reference.statistics}["volume fraction"].values
        solid = (model.to_numpy(model.domain) < 0).mean()
        self.assertAlmostEqual(float(fraction[0]), solid, delta=0.01)
        self.assertEqual(found.distances[1].scales[0].wasserstein, 0)
        self.assertLess(found.distances[1].surface.hausdorff, 1e-3)
        self.assertGreater(found.distances[0].verified, 0.8)
        self.assertGreater(found.distances[0].novelty.voxels, 1000)
        self.assertTrue(found.distances[0].verdicts)
        self.assertEqual(found.others[0].domain, ((0, 0, 0), (95, 47, 47)))
        self.fails("InvalidOption", "`names`: must be 2", vdbsynth.compare, model, model, names=["a"])
        self.fails("ShapeMismatch", "`maps`: must be one", vdbsynth.compare, model, model, maps=[result.map] * 2)

    def test_yardstick(self):
        model = vdbsynth.make("balls", resolution=32, feature=8.0, seed=1)
        other = vdbsynth.make("balls", resolution=32, feature=8.0, seed=2)
        found = vdbsynth.compare(model, other, process={"kind": "balls", "feature": 8.0}, fresh=3, stationary="xyz", reliefRadius=None)
        self.assertEqual(found.stationary, [True, True, True])
        self.assertTrue(found.yardsticks)
        self.assertTrue(all(0 <= stick.ratio < 10 for stick in found.yardsticks))


if __name__ == "__main__":
    unittest.main(verbosity=2)
