"""mask and render of the Python module: what the program writes, voxel for voxel and pixel for pixel."""
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy
import vdbsynth

from module_test import PROGRAM, SOURCE, ModuleTest, ball, distances, pyopenvdb

sys.path.insert(0, str(SOURCE / "tests" / "cli"))
from render_test import picture as png


class PictureTest(ModuleTest):
    def tool(self, *words):
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr

    def pixels(self, name):
        """[rows, columns, channels] of a PNG."""
        width, height, channels, rows = png(self.read(name))
        return numpy.frombuffer(b"".join(rows), "uint8").reshape(height, width, channels)


class Masks(PictureTest):
    def same(self, mask, *words):
        """The mask and the program's file are equal, bytes and all, given the metadata that only it writes."""
        self.tool("mask", *words, "-o", "t.vdb", "-q")
        self.assertEqual((mask.name, mask.type), ("mask", "bool"))
        vdbsynth.write_grids(self.path("own.vdb"), [mask], vdbsynth.file_metadata(self.path("t.vdb")))
        self.assertEqual(self.read("own.vdb"), self.read("t.vdb"))

    def test_every_kind_is_the_programs(self):
        self.tool("make", "balls", "b.vdb", "--resolution", 32)
        model = vdbsynth.read_model(self.path("b.vdb"))
        self.same(vdbsynth.mask("box", box=((-4, 4, 4), (20, 20, 19))), "box", "--box", "-4,4,4,20,20,19")
        self.same(vdbsynth.mask("box", box=(0, 0, 0, 3, 4, 5), voxelSize=0.25), "box", "--box", "0,0,0,3,4,5", "--voxel-size", 0.25)
        self.same(vdbsynth.mask("ball", center=(9, 8.5, 7), radius=6, voxelSize=0.5), "ball", "--center", "9,8.5,7", "--radius", 6, "--voxel-size", 0.5)
        self.same(vdbsynth.mask("inside", model), "inside", "b.vdb")
        for threads in (1, 3):
            self.same(vdbsynth.mask("range", model, range=(-1, 0.5), threads=threads), "range", "b.vdb", "--range=-1,0.5")
        grid = vdbsynth.read_grids(self.path("b.vdb"))[0]
        self.same(vdbsynth.mask("range", grid, range=(-1, 0.5)), "range", "b.vdb", "--range=-1,0.5")
        if pyopenvdb:
            self.same(vdbsynth.mask("range", model.to_openvdb(), range=(-1, 0.5)), "range", "b.vdb", "--range=-1,0.5")

    def test_what_a_mask_holds(self):
        box = vdbsynth.mask("box", box=((1, 2, 3), (3, 3, 3)))
        self.assertEqual((box.active_box, box.active_voxels), (((1, 2, 3), (3, 3, 3)), 6))
        self.assertTrue(box.to_numpy().all())
        model = ball()
        inside = vdbsynth.mask("inside", model)
        numpy.testing.assert_array_equal(inside.active(model.box), model.to_numpy() < 0)
        numpy.testing.assert_array_equal(inside.transform, model.transform)
        labels = vdbsynth.Grid.from_numpy(numpy.arange(1.0, 9).reshape(2, 2, 2))
        one = vdbsynth.mask("range", labels, range=5)  # a number: this value only
        self.assertEqual(one.active_box, ((1, 0, 0), (1, 0, 0)))

    def test_a_mask_is_an_option(self):
        exemplar = vdbsynth.make("grid", resolution=32)
        part = numpy.zeros((32, 32, 32), bool)
        part[:, :, :24] = True
        one = vdbsynth.synth(exemplar, size="1x,1x,2x", exemplarMask=vdbsynth.mask("box", box=((0, 0, 0), (31, 31, 23))))
        other = vdbsynth.synth(exemplar, size="1x,1x,2x", exemplarMask=vdbsynth.Grid.from_numpy(part))
        self.assertEqual(one.model.hash, other.model.hash)

    def test_errors(self):
        model = ball()
        cases = [("mask box: give `box`", ("box",), {}), ("`box` 5,0,0,1,9,9: must be", ("box",), {"box": ((5, 0, 0), (1, 9, 9))}),
                 ("mask ball: give `center` and `radius`", ("ball",), {"radius": 3}), ("`radius` 0: must be above 0", ("ball",), {"center": (0, 0, 0), "radius": 0}),
                 ("`center` .*within 100 million voxels", ("ball",), {"center": (0, 1e9, 0), "radius": 2}), ("`voxelSize` -1: must be", ("box",), {"box": (0, 0, 0, 1, 1, 1), "voxelSize": -1}),
                 ("mask range: give `range`", ("range", model), {}), ("`range` 2,1: must be", ("range", model), {"range": (2, 1)}),
                 ("mask inside: give a model", ("inside",), {}), ("mask box: takes no model", ("box", model), {"box": (0, 0, 0, 1, 1, 1)}),
                 ("`kind` blob: must be one of box, ball, inside, range", ("blob",), {})]
        for says, given, more in cases:
            self.assertEqual(self.fails("InvalidOption", says, vdbsynth.mask, *given, **more).exit_code, 2)
        self.fails("Memory", "`radius` 2000 needs", vdbsynth.mask, "ball", center=(0, 0, 0), radius=2000, maxMemory=1 << 20)
        for says, given, more in [("`model`: must be a LevelSet", ("inside", 3), {}), ("`model`: must be a LevelSet or a grid of floats", ("range", vdbsynth.mask("inside", model)), {"range": 1}),
                                  ("mask: unknown keyword centre; did you mean center", ("ball",), {"centre": (0, 0, 0)}), ("`radius`: must be float, not str", ("ball",), {"radius": "3"})]:
            with self.assertRaisesRegex(TypeError, says):
                vdbsynth.mask(*given, **more)
        said = []
        vdbsynth.mask("inside", model, radius=3.0, onMessage=lambda *words: said.append(words))
        self.assertEqual(said, [("note", "`radius` has no effect on mask inside")])

    def test_cancel(self):
        event = threading.Event()
        threading.Timer(0.3, event.set).start()
        start = time.monotonic()
        self.fails("Cancelled", "interrupted", vdbsynth.mask, "ball", center=(0, 0, 0), radius=5000.0, cancel=event)
        self.assertLess(time.monotonic() - start, 60)


class Pictures(PictureTest):
    def setUp(self):
        super().setUp()
        self.tool("make", "balls", "b.vdb", "--resolution", 32, "-q")
        self.model = vdbsynth.read_model(self.path("b.vdb"))

    def same(self, models, words, inputs=("b.vdb",), size=(96, 64), **more):
        """The array, the file that it writes and the program's are one picture."""
        self.tool("render", *inputs, "-o", "t.png", "--size", f"{size[0]}x{size[1]}", *words)
        drawn = vdbsynth.render(models, self.path("own.png"), size=size, **more)
        self.assertEqual(drawn.dtype, numpy.uint8)
        numpy.testing.assert_array_equal(drawn, self.pixels("t.png"))
        self.assertEqual(self.read("own.png"), self.read("t.png"))
        return drawn

    def test_a_model_and_its_camera(self):
        plain = self.same(self.model, [])
        self.assertEqual(plain.shape, (64, 96, 3))  # rows, columns
        self.assertGreater(len(numpy.unique(plain.reshape(-1, 3), axis=0)), 200)
        seen = [self.same(self.model, ["--view", "0,-1,0.2"], view=(0, -1, 0.2)), self.same(self.model, ["--up", "y"], up="y"),
                self.same(self.model, ["--no-ground", "--samples", 1], ground=False, samples=1)]
        for other in seen:
            self.assertTrue((other != plain).any())

    def test_backgrounds(self):
        clear = self.same(self.model, ["--background", "transparent"], background="transparent")
        self.assertEqual(clear.shape, (64, 96, 4))
        self.assertEqual((clear[0, 0, 3], clear[32, 48, 3]), (0, 255))
        blue = self.same(self.model, ["--background", "#204060", "--no-ground"], background="#204060", ground=False)
        numpy.testing.assert_allclose(blue[0, 0].astype(int), (0x20, 0x40, 0x60), atol=1)

    def test_rows(self):
        self.tool("make", "grid", "g.vdb", "--resolution", 40, "-q")
        models = [self.model, vdbsynth.read_model(self.path("g.vdb"))]
        named = self.same(models, [], ["b.vdb", "g.vdb"], captions=["b.vdb", "g.vdb"])
        self.assertEqual(named.shape, (64, 192, 3))
        self.same(models, ["--captions", "none", "--same-scale"], ["b.vdb", "g.vdb"], sameScale=True)
        three = self.same([*models, self.model], ["--captions", "a,b\\,,c", "--columns", 2], ["b.vdb", "g.vdb", "b.vdb"], captions=["a", "b,", "c"], columns=2)
        self.assertEqual(three.shape, (128, 192, 3))

    def test_wireframe_and_slices(self):
        wired = self.same(self.model, ["--wireframe"], wireframe=True)
        self.assertTrue((wired != vdbsynth.render(self.model, size=(96, 64))).any())
        for given in ("x=0.3", ("x", 0.3)):
            cut = self.same(self.model, ["--slice", "x=0.3"], size=(200, 160), slice=given)
        self.assertEqual(cut.shape, (160, 200, 3))
        # The faces of the mesh that a model was made from.
        self.model.to_mesh(adaptivity=1.0).write(self.path("m.ply"))
        read = vdbsynth.read_model(self.path("m.ply"), resolution=32, keepSource=True, onMessage=lambda *words: None)
        faces = self.same(read, ["--wireframe", "--resolution", 32], ["m.ply"], wireframe=True)
        level = vdbsynth.read_model(self.path("m.ply"), resolution=32, onMessage=lambda *words: None)
        self.assertTrue((vdbsynth.render(level, size=(96, 64), wireframe=True) != faces).any())

    def test_colours_and_directions(self):
        mesh = ball(size=33, voxel=1.0, radius=12.0).to_mesh()
        mesh = vdbsynth.Mesh(mesh.points, mesh.triangles, mesh.quads, attributes={"Cd": mesh.points / 32, "other": mesh.points[:, ::-1] / 32})
        vdbsynth.LevelSet.from_mesh(mesh, 1.0).write(self.path("c.vdb"))
        model = vdbsynth.read_model(self.path("c.vdb"), carry=True)
        pictures = [self.same(model, [], ["c.vdb"])]
        pictures.append(self.same(model, ["--color", "other"], ["c.vdb"], color="other"))
        pictures.append(self.same(model, ["--color", "none"], ["c.vdb"], color="none"))
        low, high = model.box
        along = numpy.zeros([h - l + 1 for l, h in zip(low, high)] + [3], "float32")
        along[..., 2] = 1
        vdbsynth.write_grids(self.path("d.vdb"), [vdbsynth.Grid.from_numpy(along, 1.0, low, name="d")])
        pictures.append(self.same(model, ["--directions", "d.vdb:d"], ["c.vdb"], directions=vdbsynth.read_grids(self.path("d.vdb"))[0]))
        self.assertEqual(len({picture.tobytes() for picture in pictures}), 4)
        self.fails("BadData", "`color` none such: not in the model, which has Cd .*, other ", vdbsynth.render, model, color="none such")

    def test_fog(self):
        density = numpy.clip(-distances((24, 24, 24), 1.0, 9.0, (12, 12, 12)) / 9, 0, 1)
        fog = vdbsynth.Grid.from_numpy(density, name="density")
        tint = vdbsynth.Grid.from_numpy(numpy.full((24, 24, 24, 3), (0.9, 0.2, 0.1), "float32"), name="Cd")
        vdbsynth.write_grids(self.path("f.vdb"), [fog])
        vdbsynth.write_grids(self.path("t.vdb"), [fog, tint])
        plain = self.same(fog, [], ["f.vdb"])
        thin = self.same(fog, ["--density", 0.1, "--background", "transparent"], ["f.vdb"], density=0.1, background="transparent")
        self.assertEqual(thin.shape[2], 4)
        tinted = self.same([[fog, tint]], [], ["t.vdb"])
        self.assertTrue((tinted != plain).any())
        if pyopenvdb:
            self.same(fog.to_openvdb(), [], ["f.vdb"])
        self.same([self.model, fog], [], ["b.vdb", "f.vdb"], captions=["b.vdb", "f.vdb"])
        for field in ({"wireframe": True}, {"slice": "z=0.5"}):
            self.fails("InvalidOption", "the model is fog, which has no surface; `iso` gives it one", vdbsynth.render, fog, **field)
        self.fails("InvalidOption", "model 2 is no fog but distances .*LevelSet.from_openvdb", vdbsynth.render, [self.model, self.model.grid])

    def test_turntable(self):
        self.tool("render", "b.vdb", "-o", "t.##.png", "--turntable", 3, "--size", "48x32")
        turn = vdbsynth.render(self.model, self.path("own.##.png"), size=(48, 32), turntable=3)
        self.assertEqual(turn.shape, (3, 32, 48, 3))
        for n in range(3):
            numpy.testing.assert_array_equal(turn[n], self.pixels(f"t.0{n + 1}.png"))
            self.assertEqual(self.read(f"own.0{n + 1}.png"), self.read(f"t.0{n + 1}.png"))
        self.fails("InvalidOption", "`turntable`: x.png names one file; write ####", vdbsynth.render, self.model, "x.png", turntable=3)
        self.fails("Memory", "an array of 3600 pictures needs", vdbsynth.render, self.model, size=(800, 600), turntable=3600, maxMemory=1 << 30)

    def test_any_threads_give_the_same(self):
        first = vdbsynth.render(self.model, size=(96, 64))
        for threads in (1, 2, 5):
            numpy.testing.assert_array_equal(vdbsynth.render(self.model, size=(96, 64), threads=threads), first)
        together = [None] * 3

        def draw(n):
            together[n] = vdbsynth.render(self.model, size=(96, 64), view=(1, n, 0.5))
        threads = [threading.Thread(target=draw, args=(n,)) for n in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for n in range(3):
            numpy.testing.assert_array_equal(together[n], vdbsynth.render(self.model, size=(96, 64), view=(1, n, 0.5)))

    def test_the_array_is_the_callers(self):
        drawn = vdbsynth.render(self.model, size=(32, 16))
        copy = drawn.copy()
        drawn[0, 0] = 7
        self.assertTrue((vdbsynth.render(self.model, size=(32, 16)) == copy).all())
        self.assertTrue(drawn.flags.writeable and drawn.flags.c_contiguous)

    def test_outputs(self):
        vdbsynth.render(self.model, [self.path("a.png"), pathlib.Path(self.path("b.png"))], size=(32, 16))
        self.assertEqual(self.read("a.png"), self.read("b.png"))
        before = sorted(os.listdir(self.folder))
        self.fails("InvalidOption", "`outputs` x.jpg: unknown extension; must be .png", vdbsynth.render, self.model, "x.jpg")
        self.fails("InvalidOption", "`outputs`: is empty", vdbsynth.render, self.model, [])
        self.fails("Io", "none/c.png", vdbsynth.render, self.model, [self.path("c.png"), self.path("none/c.png")])
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_errors(self):
        for says, more in [("`size` 8x64: must be from 16 to 8192 pixels", {"size": (8, 64)}), ("`view` 0,0,0: must be a direction", {"view": (0, 0, 0)}),
                           ("`background` blue: must be studio", {"background": "blue"}), ("`background` #12345g: must be", {"background": "#12345g"}),
                           ("`samples` 0: must be", {"samples": 0}), ("`density` 0: must be", {"density": 0.0}), ("`turntable` 1: must be", {"turntable": 1}),
                           ("`columns` 0: must be", {"columns": 0}), ("`captions` a,b: has 2 captions for 1 models", {"captions": ["a", "b"]}),
                           ("`up` x: must be one of y, z", {"up": "x"}), ("`slice` w=0.5: must be an axis", {"slice": "w=0.5"}), ("`slice` 2: must be a fraction", {"slice": ("z", 2)}),
                           ("`directions`: cannot be combined with `color`", {"directions": self.vectors(), "color": "Cd"})]:
            self.fails("InvalidOption", says, vdbsynth.render, self.model, **more)
        for more in ({"view": (1, 0, 0)}, {"up": "y"}, {"wireframe": True}, {"turntable": 4}, {"background": "white"}, {"ground": False},
                     {"sameScale": True}, {"color": "none"}, {"directions": self.vectors()}):
            self.fails("InvalidOption", f"`{list(more)[0]}`: cannot be combined with `slice`", vdbsynth.render, self.model, slice="z=0.5", **more)
        self.fails("InvalidOption", "`directions`: belongs to one model", vdbsynth.render, [self.model] * 2, directions=self.vectors())
        self.fails("InvalidOption", "no model to draw", vdbsynth.render, [])
        self.fails("InvalidOption", "pixels wide; at most 65535", vdbsynth.render, [self.model] * 9, size=(8192, 16))
        for says, given, more in [("`models`: must be a LevelSet, a Grid", 3, {}), ("`models`: must be a LevelSet, a Grid", "b.vdb", {}), ("`models`: must be a LevelSet, a Grid of fog", [self.model.to_mesh()], {}),
                                  ("`size`: must be .width, height.", self.model, {"size": (1, 2, 3)}), ("`background`: must be str", self.model, {"background": 3}),
                                  ("render: unknown keyword same_scale; did you mean sameScale", self.model, {"same_scale": True}), ("it takes size, view, ", self.model, {"zoom": 2})]:
            with self.assertRaisesRegex(TypeError, says):
                vdbsynth.render(given, **more)

    def vectors(self):
        return vdbsynth.Grid.from_numpy(numpy.ones((4, 4, 4, 3), "float32"))

    def test_progress_and_messages(self):
        stages, said = [], []
        vdbsynth.render(self.model, size=(64, 48), captions=["π"], onProgress=lambda *now: stages.append((*now, threading.get_ident())),
                        onMessage=lambda *words: said.append(words))
        self.assertIn("rendering", {stage for stage, *_ in stages})
        self.assertEqual({at for *_, at in stages}, {threading.get_ident()})
        self.assertTrue(any("without a letter" in text for _, text in said), said)

    def test_cancel(self):
        event = threading.Event()
        threading.Timer(0.3, event.set).start()
        start = time.monotonic()
        self.fails("Cancelled", "interrupted", vdbsynth.render, self.model, self.path("x.####.png"), size=(4000, 3000), turntable=200, cancel=event)
        self.assertLess(time.monotonic() - start, 60)
        self.assertEqual(sorted(os.listdir(self.folder)), ["b.vdb"])

    def test_an_interrupt_ends_the_run(self):
        code = ("import vdbsynth\n"
                "model = vdbsynth.make('balls', resolution=32)\n"
                "print('ready', flush=True)\n"
                "try: vdbsynth.render(model, size=(4000, 3000), turntable=200)\n"
                "except KeyboardInterrupt: print('interrupted')\n"
                "print(vdbsynth.render(model, size=(32, 16)).shape)\n")
        child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "ready\n")
        time.sleep(0.5)
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.communicate(timeout=120)[0], "interrupted\n(16, 32, 3)\n")

    def test_other_threads_continue(self):
        counted, event = [0], threading.Event()

        def count():
            while not event.is_set():
                counted[0] += 1
                time.sleep(0.001)
        thread = threading.Thread(target=count)
        thread.start()
        before, start = counted[0], time.monotonic()
        vdbsynth.render(self.model, size=(800, 600), turntable=2)
        during, seconds = counted[0] - before, time.monotonic() - start
        event.set()
        thread.join()
        self.assertGreater(during, 20 * seconds)


if __name__ == "__main__":
    unittest.main(verbosity=2)
