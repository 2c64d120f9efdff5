"""The Python module vdbsynth: arrays, files, grids of pyopenvdb, calls, and the pages about it."""
import contextlib
import io
import json
import logging
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy
import vdbsynth

try:
    import pyopenvdb
except ImportError:
    pyopenvdb = None

PROGRAM = os.environ["VDBSYNTH_PROGRAM"]
SOURCE = pathlib.Path(os.environ["VDBSYNTH_SOURCE"])


def distances(size, voxel, radius, middle):
    """Signed distances [world] to a ball, [x, y, z] with origin 0."""
    axes = [numpy.arange(n) * voxel - m for n, m in zip(size, middle)]
    x, y, z = numpy.meshgrid(*axes, indexing="ij")
    return (numpy.sqrt(x * x + y * y + z * z) - radius).astype("float32")


def ball(size=25, voxel=0.5, radius=4.0, **more):
    middle = [(size - 1) / 2 * voxel] * 3
    return vdbsynth.LevelSet.from_numpy(distances([size] * 3, voxel, radius, middle), voxel, **more)


class ModuleTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="vdbsynth_module_")

    def tearDown(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def read(self, name):
        return pathlib.Path(self.path(name)).read_bytes()

    def fails(self, code, says, function, *given, **more):
        with self.assertRaises(vdbsynth.Error) as caught:
            function(*given, **more)
        self.assertEqual(caught.exception.code, code)
        self.assertRegex(str(caught.exception), says)
        self.assertNotIn("\n", str(caught.exception))
        return caught.exception


class Arrays(ModuleTest):
    def test_axes_and_origin(self):
        # A ball off the middle of an array of three different sides tells axes, origin and voxel size apart.
        size, voxel, middle = (16, 20, 28), 0.25, numpy.array([1.75, 2.0, 4.5])
        model = vdbsynth.LevelSet.from_numpy(distances(size, voxel, 1.5, middle), voxel, origin=(10, -2, 3.5))
        points = model.to_mesh().points
        numpy.testing.assert_allclose((points.max(0) + points.min(0)) / 2, middle + (10, -2, 3.5), atol=0.02)
        numpy.testing.assert_allclose(points.max(0) - points.min(0), [3, 3, 3], atol=0.05)
        low, high = model.domain
        self.assertEqual(low, (42, -5, 27))  # whole voxels from zero: index space is the world's lattice
        numpy.testing.assert_allclose(model.transform @ (*low, 1), [10.5, -1.25, 6.75, 1])
        self.assertEqual(model.voxel_size, 0.25)
        self.assertFalse(model.domainRecorded)

    def test_an_origin_between_voxels_moves_the_transform(self):
        model = ball(origin=(0.1, 0, 0))
        numpy.testing.assert_allclose(model.transform[:3, 3], [0.1, 0, 0])
        self.assertAlmostEqual(float(model.to_mesh().points.max()), 10.1, places=1)

    def test_to_numpy_and_back_is_the_same(self):
        model = vdbsynth.make("balls", resolution=32, seed=2)
        values = model.to_numpy()
        self.assertEqual(values.dtype, numpy.float32)
        low, high = model.box
        self.assertEqual(values.shape, tuple(h - l + 1 for l, h in zip(low, high)))
        again = vdbsynth.LevelSet.from_numpy(values, model.voxel_size, model.origin).with_domain(model.domain)
        numpy.testing.assert_array_equal(again.to_numpy(model.box), values)
        numpy.testing.assert_array_equal(again.grid.active(model.box), model.grid.active(model.box))
        self.assertEqual((again.domain, again.domainRecorded), (model.domain, True))
        # Single voxels: an element is the voxel box.min + (i, j, k).
        part = model.to_numpy(((5, 6, 7), (8, 8, 8)))
        numpy.testing.assert_array_equal(part, values[5 - low[0]:9 - low[0], 6 - low[1]:9 - low[1], 7 - low[2]:9 - low[2]])

    def test_a_solid_below_a_value_and_back_as_volumes(self):
        distance = distances((21, 21, 21), 1.0, 6.0, (10, 10, 10))
        model = vdbsynth.LevelSet.from_volume(distance, below=0.0)
        model.write([self.path("inside.npy")])
        model.write([self.path("distance.npy")], values="distance")
        inside, far = numpy.load(self.path("inside.npy")), numpy.load(self.path("distance.npy"))
        self.assertEqual((inside.dtype, far.dtype), (numpy.uint8, numpy.float32))
        numpy.testing.assert_array_equal(inside, distance.transpose(2, 1, 0) < 0)
        near = abs(far) < 1.5
        numpy.testing.assert_allclose(far[near], distance.transpose(2, 1, 0)[near], atol=0.15)

    def test_a_texture_is_capped_at_its_array(self):
        rows = numpy.arange(16.0)
        height = numpy.broadcast_to(rows - 7.5, (24, 20, 16)).astype("float32")  # solid below z = 7.5
        model = vdbsynth.LevelSet.from_numpy(height, 1.0, domainRecorded=True)
        self.assertEqual(model.domain, ((0, 0, 0), (23, 19, 15)))
        self.assertTrue(model.domainRecorded)
        points = model.to_mesh().points
        numpy.testing.assert_allclose(points.min(0), [-0.5] * 3, atol=0.1)
        numpy.testing.assert_allclose(points.max(0), [23.5, 19.5, 7.5], atol=0.1)

    def test_a_solid_that_the_array_cuts_is_a_piece(self):
        said = []
        values = distances((20, 20, 20), 1.0, 7.0, (0, 10, 10))
        model = vdbsynth.LevelSet.from_numpy(values, onMessage=lambda level, text: said.append((level, text)))
        self.assertTrue(any("cut open at low x" in text for level, text in said), said)
        self.assertTrue(model.domainRecorded)
        points = model.to_mesh().points
        numpy.testing.assert_allclose([points[:, 0].min(), points[:, 0].max()], [-0.5, 7], atol=0.2)

    def test_a_volume_is_what_convert_makes_of_its_file(self):
        rng = numpy.random.default_rng(3)
        volume = rng.random((18, 20, 22)).astype("float32")
        for _ in range(3):
            volume = (volume + numpy.roll(volume, 1, 0) + numpy.roll(volume, 1, 1) + numpy.roll(volume, 1, 2)) / 4
        numpy.save(self.path("v.npy"), volume)
        subprocess.run([PROGRAM, "convert", "v.npy", "-o", "v.vdb", "--threshold", "0.5", "-q"], cwd=self.folder, check=True)
        made = vdbsynth.read_model(self.path("v.vdb"))
        # In a file the last index runs along x.
        own = vdbsynth.LevelSet.from_volume(volume.transpose(2, 1, 0), threshold=0.5)
        numpy.testing.assert_array_equal(own.to_numpy(made.box), made.to_numpy(made.box))
        self.assertEqual((own.domain, own.domainRecorded), (made.domain, True))

    def test_meshes_and_points(self):
        points = numpy.array([[x, y, z] for x in (0, 2) for y in (0, 3) for z in (0, 4)], "float64")
        faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
        mesh = vdbsynth.Mesh(points, faces, attributes={"Cd": points / 4, "age": points[:, 2]})
        self.assertEqual(mesh.attributes["Cd"].shape, (8, 3))
        mesh.write(self.path("box.ply"))
        own = vdbsynth.LevelSet.from_mesh(mesh, 0.125)
        read = vdbsynth.read_model(self.path("box.ply"), voxelSize=0.125, carry=True)
        self.assertEqual(own.hash, read.hash)
        self.assertEqual([g.name for g in own.attributes], ["Cd", "age"])
        cloud = own.to_points(spacing=0.75, seed=1)
        self.assertEqual(cloud.points.shape, cloud.normals.shape)
        numpy.testing.assert_allclose(cloud.attributes["age"], cloud.points[:, 2], atol=0.1)
        again = vdbsynth.LevelSet.from_points(cloud, 0.125)
        self.assertLess(vdbsynth.compare(own, again).distances[0].surface.mean, 0.5)
        with self.assertRaisesRegex(ValueError, "`triangles`: holds 8, but there are 8 points"):
            vdbsynth.Mesh(points, [[0, 1, 8]])

    def test_grids_of_every_type(self):
        for dtype, name in [("float32", "float"), ("float64", "double"), ("int32", "int32"), ("uint8", "int32"), ("int64", "int64"), ("bool", "bool")]:
            array = (numpy.arange(2 * 3 * 4).reshape(2, 3, 4) % 5).astype(dtype)
            grid = vdbsynth.Grid.from_numpy(array, 2.0, (4, 6, 8), name="g")
            self.assertEqual((grid.name, grid.type), ("g", name))
            numpy.testing.assert_array_equal(grid.to_numpy(((2, 3, 4), (3, 5, 7))), array)
            numpy.testing.assert_array_equal(grid.active(((2, 3, 4), (3, 5, 7))), array != 0)
        vectors = numpy.arange(24, dtype="float32").reshape(2, 2, 2, 3)
        grid = vdbsynth.Grid.from_numpy(vectors, background=-1)
        self.assertEqual(grid.type, "vec3s")
        numpy.testing.assert_array_equal(grid.to_numpy(), vectors)
        with self.assertRaisesRegex(TypeError, "complex64"):
            vdbsynth.Grid.from_numpy(numpy.zeros((2, 2, 2), "complex64"))

    def test_bad_arrays(self):
        nan = distances((12, 12, 12), 1, 4, (6, 6, 6))
        nan[6, 6, 2] = numpy.nan
        self.fails("BadData", "NaN", vdbsynth.LevelSet.from_numpy, nan)
        self.fails("EmptyInput", "the array", vdbsynth.LevelSet.from_numpy, numpy.ones((8, 8, 8), "float32"))
        self.fails("EmptyInput", "the array", vdbsynth.LevelSet.from_numpy, numpy.ones((8, 8, 8), "float32"), domainRecorded=True)
        self.fails("InvalidOption", "`voxel_size` 0.0: must be above 0", ball, voxel=0.0)
        self.fails("InvalidOption", "`halfWidth` 1", ball, halfWidth=1.0)
        with self.assertRaisesRegex(ValueError, "3 dimensions, not of 8 x 8"):
            vdbsynth.LevelSet.from_numpy(numpy.ones((8, 8), "float32"))
        with self.assertRaisesRegex(TypeError, "signed distances, not bool; LevelSet.from_volume"):
            vdbsynth.LevelSet.from_numpy(numpy.ones((8, 8, 8), bool))
        self.fails("InvalidOption", "`box`", ball().to_numpy, ((5, 0, 0), (1, 9, 9)))


@unittest.skipUnless(pyopenvdb, "pyopenvdb is absent")
class Shared(ModuleTest):
    def test_a_grid_is_shared_both_ways(self):
        model = ball()
        grid = model.to_openvdb()
        self.assertIsInstance(grid, pyopenvdb.FloatGrid)
        self.assertEqual(grid.activeVoxelCount(), model.active_voxels)
        back = vdbsynth.LevelSet.from_openvdb(grid)
        self.assertEqual(back.hash, model.hash)
        # One tree: a voxel that is set there is seen here.
        grid.getAccessor().setValueOn((12, 12, 12), -1.25)
        self.assertEqual(model.to_numpy(((12, 12, 12), (12, 12, 12)))[0, 0, 0], -1.25)

    def test_the_tree_outlives_either_module(self):
        grid = ball().to_openvdb()  # the LevelSet is gone
        self.assertGreater(grid.activeVoxelCount(), 1000)
        model = vdbsynth.LevelSet.from_openvdb(grid)
        del grid
        self.assertGreater(model.active_voxels, 1000)

    def test_grids_as_options(self):
        exemplar = vdbsynth.make("grid", resolution=32)
        mask = pyopenvdb.BoolGrid()
        mask.fill((0, 0, 0), (31, 31, 23), True, True)
        masked = vdbsynth.synth(exemplar, size="1x,1x,2x", exemplarMask=mask)
        part = numpy.zeros((32, 32, 32), bool)
        part[:, :, :24] = True
        same = vdbsynth.synth(exemplar, size="1x,1x,2x", exemplarMask=vdbsynth.Grid.from_numpy(part))
        self.assertEqual(masked.model.hash, same.model.hash)
        self.assertEqual(masked.model.domain[1][2], 47)

    def test_types_without_a_class_are_refused(self):
        grid = vdbsynth.Grid.from_numpy(numpy.ones((2, 2, 2), "int32"))
        with self.assertRaisesRegex(TypeError, "Tree_int32.* to_numpy"):
            grid.to_openvdb()
        with self.assertRaisesRegex(TypeError, "must be a grid of pyopenvdb, not int"):
            vdbsynth.Grid.from_openvdb(3)

    def test_either_is_imported_first(self):
        for order in ("vdbsynth, pyopenvdb", "pyopenvdb, vdbsynth"):
            code = f"import {order}; print(vdbsynth.make('balls', resolution=32).to_openvdb().activeVoxelCount() > 0)"
            done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout), (0, "True\n"), done.stderr)


class Files(ModuleTest):
    def test_outputs_appear_together_or_not_at_all(self):
        model = ball()
        model.write([self.path("a.vdb"), pathlib.Path(self.path("a.obj"))])
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.obj", "a.vdb"])
        before = self.read("a.vdb")
        self.fails("Io", "none/b.obj", vdbsynth.make("balls", resolution=32).write, [self.path("a.vdb"), self.path("none/b.obj")])
        self.assertEqual(self.read("a.vdb"), before)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.obj", "a.vdb"])
        self.fails("InvalidOption", "a.xyz", model.write, self.path("a.xyz"))

    def test_grids_of_a_file_that_pyopenvdb_refuses(self):
        made = vdbsynth.synth(vdbsynth.make("grid", resolution=32), size="2x,1x,1x")
        made.model.write(self.path("m.vdb"), extraGrids=made.map.to_grids(made.model), metadata={"shot": "12"})
        if pyopenvdb:
            with self.assertRaises(Exception):
                pyopenvdb.readAll(self.path("m.vdb"))
        found = {one["name"]: one for one in vdbsynth.grids(self.path("m.vdb"))}
        self.assertEqual(found["source"]["type"], "vec3i")
        self.assertEqual(found["surface"]["gridClass"], "level set")
        self.assertEqual(found["surface"]["metadata"]["vdbsynth:domain"], "0,0,0,63,31,31")
        self.assertEqual(found["surface"]["activeVoxels"], made.model.active_voxels)
        self.assertEqual(vdbsynth.file_metadata(self.path("m.vdb")), {"shot": "12"})
        self.assertEqual({g.name for g in vdbsynth.read_grids(self.path("m.vdb"))}, set(found))
        # What pyopenvdb does read.
        vdbsynth.write_grids(self.path("f.vdb"), made.map.to_grids(made.model, types="float"))
        if pyopenvdb:
            self.assertGreater(len(pyopenvdb.readAll(self.path("f.vdb"))[0]), 1)

    def test_missing_and_bad_files(self):
        error = self.fails("Io", "none.vdb", vdbsynth.read_model, self.path("none.vdb"))
        self.assertEqual(error.exit_code, 3)
        pathlib.Path(self.path("bad.vdb")).write_bytes(b"no grid at all")
        self.assertEqual(self.fails("BadData", "bad.vdb", vdbsynth.grids, self.path("bad.vdb")).exit_code, 3)
        self.fails("InvalidOption", "unknown extension", vdbsynth.read_model, "a.doc")


class SameAsProgram(ModuleTest):
    """The same bytes as the command line's, given the metadata that only it writes."""

    def tool(self, *words):
        done = subprocess.run([PROGRAM, *words, "-q"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def same(self, model, name, **more):
        model.write(self.path("own.vdb"), metadata=vdbsynth.file_metadata(self.path(name)), **more)
        self.assertEqual(self.read("own.vdb"), self.read(name))

    def test_synth(self):
        self.tool("make", "balls", "e.vdb", "--resolution", "40", "--seed", "5")
        self.tool("synth", "e.vdb", "-o", "t.vdb", "-o", "t.obj", "--size", "2x,56,1x", "--seed", "9", "--border", "object,cut,cut", "--source-map")
        made = vdbsynth.synth(vdbsynth.read_model(self.path("e.vdb")), size=("2x", 56, "1x"), seed=9, border=("object", "cut", "cut"), threads=1)
        self.same(made.model, "t.vdb", extraGrids=made.map.to_grids(made.model))
        made.model.write(self.path("own.obj"))
        self.assertEqual(self.read("own.obj"), self.read("t.obj"))
        self.same(vdbsynth.make("balls", resolution=40, seed=5), "e.vdb")

    def test_analogy(self):
        self.tool("make", "grooves", "a.vdb", "a2.vdb", "--resolution", "40")
        ball(voxel=2.0, radius=18.0).write(self.path("b.vdb"))
        self.tool("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "t.vdb", "--direction", "axis:z", "--sweeps", "1")
        models = [vdbsynth.read_model(self.path(name)) for name in ("a.vdb", "a2.vdb", "b.vdb")]
        made = vdbsynth.analogy(tuple(models[:2]), models[2], direction="axis:z", sweeps=1)
        self.same(made.model, "t.vdb")

    def test_convert(self):
        ball().to_mesh().write(self.path("m.ply"))
        self.tool("convert", "m.ply", "-o", "t.vdb", "-o", "t.stl", "--resolution", "48", "--adaptivity", "0.5")
        vdbsynth.convert(self.path("m.ply"), [self.path("own.vdb"), self.path("own.stl")], resolution=48, adaptivity=0.5,
                         metadata=vdbsynth.file_metadata(self.path("t.vdb")))
        for kind in ("vdb", "stl"):
            self.assertEqual(self.read("own." + kind), self.read("t." + kind))

    def test_relief_and_patches(self):
        wave = (numpy.sin(numpy.arange(32) * numpy.pi / 8)[None, :] * 0.5 + 0.5) * numpy.ones((32, 1))
        self.tool("make", "chainmail", "mail.ply", "--resolution", "64")
        self.tool("patch", "mail.ply", "--size", "1.5x,1.5x", "-o", "sheet.ply", "--seed", "4")
        source = vdbsynth.read_patch_source(self.path("mail.ply"))
        sheet = vdbsynth.patch(source, width=1.5 * source.size[0], depth=1.5 * source.size[1], seed=4)
        sheet.points().write(self.path("own.ply"))
        self.assertEqual(self.read("own.ply"), self.read("sheet.ply"))
        target = ball(size=33, voxel=1.0, radius=12.0)
        target.write(self.path("b.vdb"))
        pixels = (wave * 65535).round().astype(">u2")
        pathlib.Path(self.path("w.pgm")).write_bytes(b"P5 32 32 65535\n" + pixels.tobytes())
        self.tool("relief", "w.pgm", "b.vdb", "-o", "t.obj", "--height", "2", "--tile", "yes", "--seed", "3")
        sample = vdbsynth.read_samples(self.path("w.pgm"), tile="yes")[0]
        made = vdbsynth.relief(vdbsynth.Heights(sample.image.mean(2, dtype="float32"), height=2.0, tileable=True), target, seed=3)
        made.model.write(self.path("own.obj"))
        self.assertEqual(self.read("own.obj"), self.read("t.obj"))


class Calls(ModuleTest):
    def exemplar(self):
        return vdbsynth.make("foam", resolution=48)

    def test_progress(self):
        seen = []
        vdbsynth.synth(self.exemplar(), size="2x,1x,1x", onProgress=lambda *now: seen.append((*now, threading.get_ident())))
        self.assertGreater(len({stage for stage, *_ in seen}), 1)
        last = {}
        for stage, done, total, thread in seen:
            self.assertEqual(thread, threading.get_ident())
            self.assertLessEqual(done, total)
            self.assertGreaterEqual(done, last.get(stage, 0))
            last[stage] = done

    def test_messages(self):
        ball().to_mesh().write(self.path("m.obj"))
        said = []
        vdbsynth.read_model(self.path("m.obj"), onMessage=lambda level, text: said.append((level, text)))
        self.assertTrue(any(level == "note" and "`resolution` or `voxelSize` sets it" in text for level, text in said), said)
        with self.assertLogs("vdbsynth", logging.INFO) as logged:
            vdbsynth.read_model(self.path("m.obj"))
        self.assertRegex("\n".join(logged.output), "INFO:vdbsynth:.*voxel size")
        # Warnings reach standard error of a program that configures nothing.
        code = "import vdbsynth, numpy; v = numpy.zeros((9, 9, 9), bool); v[4:6, 2:7, 2:7] = True; vdbsynth.LevelSet.from_volume(v)"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertRegex(done.stderr, "the array: .* lost")

    def test_cancel(self):
        event = threading.Event()
        threading.Timer(0.3, event.set).start()
        start = time.monotonic()
        error = self.fails("Cancelled", "interrupted", vdbsynth.synth, self.exemplar(), size="8x,8x,8x", cancel=event)
        self.assertEqual(error.exit_code, 130)
        self.assertLess(time.monotonic() - start, 30)
        # Nothing is written.
        self.fails("Cancelled", "interrupted", ball().write, self.path("a.vdb"), cancel=event)
        self.assertEqual(os.listdir(self.folder), [])

    def test_an_interrupt_ends_the_run(self):
        code = ("import vdbsynth, sys\n"
                "exemplar = vdbsynth.make('foam', resolution=48)\n"
                "print('ready', flush=True)\n"
                "try: vdbsynth.synth(exemplar, size='8x,8x,8x')\n"
                "except KeyboardInterrupt: print('interrupted')\n"
                "print(vdbsynth.make('balls', resolution=32))\n")
        child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "ready\n")
        time.sleep(0.5)
        start = time.monotonic()
        child.send_signal(signal.SIGINT)
        rest = child.communicate(timeout=120)[0]
        self.assertRegex(rest, r"^interrupted\n<vdbsynth\.LevelSet")
        self.assertLess(time.monotonic() - start, 30)

    def test_what_a_callback_raises_ends_the_run(self):
        def stop(stage, done, total):
            raise RuntimeError("enough")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            vdbsynth.synth(self.exemplar(), size="8x,8x,8x", onProgress=stop)

    def test_other_threads_continue(self):
        counted, event = [0], threading.Event()

        def count():
            while not event.is_set():
                counted[0] += 1
                time.sleep(0.001)
        thread = threading.Thread(target=count)
        thread.start()
        before = counted[0]
        start = time.monotonic()
        vdbsynth.synth(self.exemplar(), size="2x,2x,1x")
        seconds = time.monotonic() - start
        during = counted[0] - before
        event.set()
        thread.join()
        # A millisecond each if the lock is free; a held lock lets none through.
        self.assertGreater(during, 20 * seconds)

    def test_calls_at_once_give_what_they_give_alone(self):
        exemplar = vdbsynth.make("grid", resolution=32)
        alone = [vdbsynth.synth(exemplar, size="2x,1x,1x", seed=s).model.hash for s in range(3)]
        together = [None] * 3

        def run(seed):
            together[seed] = vdbsynth.synth(exemplar, size="2x,1x,1x", seed=seed).model.hash
        threads = [threading.Thread(target=run, args=(s,)) for s in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(together, alone)
        self.assertEqual(len(set(alone)), 3)
        self.assertEqual(vdbsynth.synth(exemplar, size="2x,1x,1x", seed=1, threads=1).model.hash, alone[1])

    def test_errors(self):
        model = ball()
        cases = [("InvalidOption", 2, lambda: vdbsynth.synth(model, longestRun=3)), ("Io", 3, lambda: vdbsynth.read_model("none.obj")),
                 ("Unusable", 1, lambda: vdbsynth.synth(model, block=200)), ("Memory", 1, lambda: vdbsynth.synth(self.exemplar(), size="4x,4x,4x", maxMemory=1000)),
                 ("ShapeMismatch", 1, lambda: vdbsynth.synth([model, ball(voxel=0.25)]))]
        for code, exit_code, run in cases:
            self.assertEqual(self.fails(code, ".", run).exit_code, exit_code)
        self.assertTrue(issubclass(vdbsynth.Error, Exception))
        self.assertEqual(vdbsynth.Error.__module__, "vdbsynth")

    def test_keywords_that_do_not_exist(self):
        model = ball()
        for wrong, says in [({"half_width": 3}, "did you mean halfWidth"), ({"longestrun": 1}, "did you mean longestRun"),
                            ({"blok": 8}, "did you mean block"), ({"sead": 1}, "did you mean seed"), ({"colour": 8}, "it takes size, exemplarBox, ")]:
            with self.assertRaisesRegex(TypeError, f"synth: unknown keyword {list(wrong)[0]}; {says}"):
                vdbsynth.synth(model, **wrong)
        with self.assertRaisesRegex(TypeError, "process: unknown keyword kinds; did you mean kind"):
            vdbsynth.compare(model, model, process={"kinds": "grid"})

    def test_values_of_another_type(self):
        model = ball()
        for given, says in [({"block": 8.0}, "`block`: must be int, not float"), ({"block": True}, "`block`: must be int, not bool"),
                            ({"draft": 1}, "`draft`: must be bool, not int"), ({"longestRun": "1"}, "`longestRun`: must be float, not str"),
                            ({"size": (1, 2)}, "`size`: must be three sizes"), ({"exemplarBox": (1, 2, 3)}, "`exemplarBox`: must be a box"),
                            ({"guide": 3}, "`guide`: must be a Grid"), ({"onProgress": 3}, "`onProgress`: must be callable"),
                            ({"cancel": 3}, "`cancel`: must be an object with is_set")]:
            with self.assertRaisesRegex(TypeError, re.escape(says)):
                vdbsynth.synth(model, **given)
        with self.assertRaisesRegex(TypeError, "a LevelSet .read_model reads files."):
            vdbsynth.crop("a.vdb", ((0, 0, 0), (1, 1, 1)))
        for word in ({"border": "round"}, {"size": "2,2"}, {"size": ("2y", 1, 1)}, {"block": 2**40}):
            self.fails("InvalidOption", f"`{list(word)[0]}`", vdbsynth.synth, model, **word)
        # Numbers of numpy are numbers.
        grid = vdbsynth.make("grid", resolution=32)
        one = vdbsynth.synth(grid, size="2x,1x,1x", block=numpy.int32(8), longestRun=numpy.float32(0.5), draft=numpy.bool_(False))
        self.assertEqual(one.stats.block, 8)


# Structs whose fields are keywords: of which functions, the header, and the fields that are given otherwise.
STRUCTS = [
    ("synth", "pipeline/synth/synth.h", "SynthOptions", {}), ("fill", "pipeline/fill/fill.h", "FillOptions", {}),
    ("repeat", "pipeline/repeat/repeat.h", "RepeatOptions", {}), ("match", "pipeline/match/match.h", "MatchOptions", {}),
    ("pose", "pipeline/pose/pose.h", "PoseOptions", {}), ("analogy", "pipeline/analogy/analogy.h", "AnalogyOptions", {"synthesis"}),
    ("analogy", "analogy/analogy_options.h", "VolumeAnalogyOptions", {}), ("filter_analogy", "analogy/analogy_options.h", "FilterAnalogyOptions", {}),
    ("make", "procedural/exemplar.h", "ExemplarOptions", {"kind"}), ("make", "pipeline/make/make.h", "MakeOptions", {"exemplar"}),
    ("make_points", "pipeline/make/make_points.h", "MakePointsOptions", {"model"}), ("compare", "pipeline/compare/compare.h", "CompareOptions", {}),
    ("read_model", "pipeline/convert/model.h", "ModelOptions", {"solid", "heights", "volume"}),
    ("read_model", "vdb/convert/mesh_to_level_set.h", "SolidOptions", {}), ("read_model", "raster/raster_options.h", "HeightOptions", {}),
    ("read_model", "raster/raster_options.h", "VolumeOptions", {}), ("LevelSet.write", "pipeline/convert/outputs.h", "ModelOutputOptions", {}),
    ("LevelSet.to_mesh", "vdb/convert/level_set_to_mesh.h", "MeshingOptions", {"source"}),
    ("LevelSet.to_points", "vdb/convert/level_set_to_points.h", "PointOptions", {}), ("LevelSet.from_openvdb", "vdb/vdb_file.h", "VdbReadOptions", {}),
    ("read_patch_source", "pipeline/patch/patch_source.h", "PatchSourceOptions", {"model"}), ("patch", "patch/patch_synthesis.h", "PatchOptions", {}),
    ("patch_onto", "pipeline/patch/patch_onto.h", "PatchOntoOptions", {"onto"}), ("patch_onto", "patch/onto/onto_synthesis.h", "OntoOptions", {}),
    ("texture", "pipeline/texture/texture.h", "TextureOptions", {"synthesis"}), ("texture", "coordinates/coordinate_synthesis.h", "CoordinateOptions", {}),
    ("Texture.write", "pipeline/texture/texture_outputs.h", "TextureOutputOptions", {"model"}),
    ("relief", "pipeline/relief/relief.h", "ReliefOptions", {"synthesis"}), ("relief", "coordinates/coordinate_synthesis.h", "CoordinateOptions", {}),
    ("relief_extract", "pipeline/relief/relief_extract.h", "ReliefExtractOptions", {}), ("ReliefResult.bake", "pipeline/relief/relief_bake.h", "ReliefBakeOptions", {}),
    ("minimal_wall", "measure/minimal_wall.h", "MinimalWallOptions", {}), ("mask", "pipeline/mask/mask.h", "MaskOptions", {"kind"}),
    ("render", "pipeline/render/render_options.h", "RenderOptions", {}),
]


def fields_of(header, struct):
    """Names of a plain struct's fields."""
    text = re.sub(r"//[^\n]*", "", (SOURCE / "libvdbsynth" / header).read_text())
    body = re.search(r"struct " + struct + r" \{(.*?)\n\};", text, re.S).group(1)
    names = []
    for statement in re.sub(r"\{[^{}]*\}|\([^()]*\)", "", body).split(";"):
        statement = re.sub(r"<[^<>]*>", "", re.sub(r"<[^<>]*>", "", statement))
        for part in statement.split(","):
            word = re.search(r"(\w+)\s*(?:=.*)?$", part.strip(), re.S)
            if word:
                names.append(word.group(1))
    return names


class Stubs(unittest.TestCase):
    def test_every_field_is_a_keyword(self):
        fields = 0
        for function, header, struct, others in STRUCTS:
            names = set(fields_of(header, struct)) - set(others)
            keywords = {name for name, *_ in vdbsynth.keywords(function)}
            self.assertEqual(names - keywords, set(), f"{struct} in {function}")
            fields += len(names)
        self.assertGreater(fields, 150)

    def test_the_stubs_are_those_of_the_module(self):
        made = subprocess.run([sys.executable, SOURCE / "tools" / "dev" / "python_stubs.py"], capture_output=True, text=True)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertEqual((SOURCE / "python" / "vdbsynth" / "__init__.pyi").read_text(), made.stdout,
                         "run PYTHONPATH=build/release/python tools/dev/python_stubs.py python/vdbsynth/__init__.pyi")

    @unittest.skipUnless(shutil.which("mypy"), "mypy is absent")
    def test_mypy_reads_them(self):
        code = ("import vdbsynth\n"
                "grid = vdbsynth.make('grid', resolution=32)\n"
                "result = vdbsynth.synth([grid, grid], size=('2x', 64, '1x'), border='cut', exemplarBox=((0, 0, 0), (9, 9, 9)), seed=3)\n"
                "result.model.write(['a.vdb'], extraGrids=result.map.to_grids(result.model), metadata={'a': 'b'})\n"
                "vdbsynth.analogy([(grid, grid)], grid, direction=(0, 0, 1))\n")
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "typed.py")
            for line, says in [("", "Success"), ("vdbsynth.synth(grid, border='round')\n", "incompatible type"), ("vdbsynth.synth(grid, blok=3)\n", "Unexpected keyword")]:
                file.write_text(code + line)
                done = subprocess.run(["mypy", "--strict", "--cache-dir", os.path.join(folder, "cache"), "typed.py"], cwd=folder,
                                      env=dict(os.environ, MYPYPATH=os.environ["PYTHONPATH"]), capture_output=True, text=True)
                self.assertIn(says, done.stdout)

    def test_every_name_has_a_text(self):
        for name in vdbsynth.__all__:
            if not isinstance(getattr(vdbsynth, name), type):
                self.assertGreater(len(getattr(vdbsynth, name).__doc__.splitlines()), 1, name)
        self.assertIn("longestRun: float = 0.3", vdbsynth.synth.__doc__)
        for function in vdbsynth.functions_with_keywords():
            for word, annotation, default, about in vdbsynth.keywords(function):
                self.assertTrue(about, f"{function} {word}")


class Docs(ModuleTest):
    def test_the_page_runs_and_prints_what_it_says(self):
        text = (SOURCE / "docs" / "python.md").read_text()
        blocks = re.findall(r"```python\n(.*?)```(?:\n```text\n(.*?)```)?", text, re.S)
        self.assertGreaterEqual(len(blocks), 7)
        names, before = {}, os.getcwd()
        os.chdir(self.folder)
        try:
            for code, says in blocks:
                if "pyopenvdb" in code and not pyopenvdb:
                    self.skipTest("pyopenvdb is absent")
                printed = io.StringIO()
                with contextlib.redirect_stdout(printed):
                    exec(compile(code, "docs/python.md", "exec"), names)
                self.assertEqual(printed.getvalue(), says, code)
        finally:
            os.chdir(before)

    def test_every_function_is_on_the_page(self):
        text = (SOURCE / "docs" / "python.md").read_text()
        for name in vdbsynth.__all__:
            if not isinstance(getattr(vdbsynth, name), type) and name not in ("keywords", "functions_with_keywords", "exemplar_kinds", "pair_kinds", "read_onto_model"):
                self.assertIn(f"`{name}`", text)


class Installed(ModuleTest):
    def test_the_component_can_be_imported(self):
        build = pathlib.Path(vdbsynth.__file__).parents[2]
        done = subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", self.folder], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        files = {str(p.relative_to(self.folder)) for p in pathlib.Path(self.folder, "lib").rglob("*") if p.is_file()}
        package = "lib/python3/dist-packages/vdbsynth/"
        self.assertEqual({f for f in files if not f.endswith(".so")}, {package + f for f in ("__init__.py", "__init__.pyi", "py.typed")})
        self.assertEqual(len([f for f in files if f.startswith(package + "_vdbsynth.cpython-") and f.endswith(".so")]), 1)
        environment = dict(os.environ, PYTHONPATH=os.path.join(self.folder, "lib/python3/dist-packages"))
        done = subprocess.run([sys.executable, "-c", "import vdbsynth; print(vdbsynth.__file__, vdbsynth.make('grid', resolution=32))"],
                              env=environment, capture_output=True, text=True, cwd="/")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(done.stdout.startswith(self.folder), done.stdout)

    def test_the_sources_alone_say_what_is_missing(self):
        environment = dict(os.environ, PYTHONPATH=str(SOURCE / "python"))
        done = subprocess.run([sys.executable, "-c", "import vdbsynth"], env=environment, capture_output=True, text=True, cwd="/")
        self.assertEqual(done.returncode, 1)
        self.assertIn("build with -DVDBSYNTH_PYTHON=ON", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
