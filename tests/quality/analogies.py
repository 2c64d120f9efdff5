#!/usr/bin/python3
"""Puts the textures of `make`'s pairs on models and measures what came of it: the angle between grooves and the direction
field, their spacing, the density of holes and whether they go through, the offset of a dilation, the heights of pictures' reliefs
and their spectrum, a blur of densities. Prints a line for each.
Usage: analogies.py BUILD_FOLDER [--analogy "OPTIONS"] [ROW...]
A row is run if its name contains one of the words. Needs numpy, scipy, skimage and pyopenvdb."""
import argparse
import json
import os
import pathlib
import shlex
import subprocess
import sys
import time

import numpy as np
import pyopenvdb as vdb
import scipy.ndimage as ndimage
import skimage.io
from skimage.measure import euler_number

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SAMPLES = pathlib.Path(os.environ.get("VDBSYNTH_SAMPLES", str(SOURCE.parent / "shared" / "data")))
BAND = 12  # [voxels] half-width of what is measured
APART = 2  # [spacings] from singularities that angles and spacings are taken at

# name: (pair, target: a kind of `make` or a sample, its resolution, direction)
ROWS = {
    "grooves-bunny": ("grooves", "meshes/bunny.off", 200, "axis:z"),
    "grooves-tori": ("grooves", "three-tori", 196, "around:z"),
    "grooves-seahorse": ("grooves", "meshes/seahorse.obj", 227, "axis:z"),
    "holes-tori": ("holes", "three-tori", 196, "around:z"),
    "pits-tori": ("pits", "three-tori", 196, "around:z"),
    "spikes-bunny": ("spikes", "meshes/bunny.off", 200, "axis:z"),
    "holes-bunny": ("holes", "meshes/bunny.off", 200, "axis:z"),
    "dilation-bunny": ("dilation", "meshes/bunny.off", 200, "axis:z"),
    "dilation-tori": ("dilation", "three-tori", 196, "around:z"),
}
# name: (target, its resolution, sigma of the blur [voxels])
BLURS = {
    "blur-tori-1": ("three-tori", 96, 1.0),
    "blur-tori-2": ("three-tori", 96, 2.0),
    "blur-bunny": ("meshes/bunny.off", 128, 1.5),
}
# name: (picture: a function below or a sample, height of white [voxels], pixels of a voxel). The target is a cylinder.
RELIEFS = {
    "relief-bricks": ("bricks", 4, 1),
    "relief-grain": ("grain", 4, 1),
    "relief-leather": ("textures/print-leather2.png", 6, 4),
    "relief-bark": ("textures/vistex-Bark-11.png", 8, 1),
    "relief-sand": ("textures/vistex-Sand-05.png", 5, 1),
}
PICTURE = 128  # [voxels] of a picture's sides
RADIUS, LENGTH = 48, 176  # [voxels] of the cylinder
BASE = 12  # [voxels] of solid below a relief
LONGEST = (64, 16, 8, 4, 2.5)  # [voxels] wavelengths between which a spectrum's bands lie
BANDS = ", ".join(f"{a:g} to {b:g}" for a, b in zip(LONGEST, LONGEST[1:]))


def bricks():
    """Rows of bricks with mortar two voxels wide, each brick of its own height: 0 to 1."""
    rows, columns = np.mgrid[0:PICTURE, 0:PICTURE]
    row = rows // 8
    column = (columns + 8 * (row % 2)) % PICTURE // 16
    heights = 0.8 + 0.2 * np.random.default_rng(5).random((PICTURE // 8, PICTURE // 16))
    return np.where((rows % 8 < 2) | ((columns + 8 * (row % 2)) % 16 < 2), 0.0, heights[row, column])


def grain():
    """The noise of a scan: normal, of 1.2 voxels' width."""
    noise = ndimage.gaussian_filter(np.random.default_rng(6).standard_normal((PICTURE, PICTURE)), 1.2, mode="wrap")
    return np.clip(0.5 + noise / (6 * noise.std()), 0, 1)


def gray_of(path, scale):
    """A square of a picture around its middle, PICTURE * scale pixels wide, 0 to 1."""
    gray = skimage.io.imread(path, as_gray=True).astype(float)
    gray /= gray.max()
    size = min(PICTURE * scale, *gray.shape)
    first = [(n - size) // 2 for n in gray.shape]
    return gray[first[0]:first[0] + size, first[1]:first[1] + size]


def bands(heights):
    """Deviation of heights [voxels] within bands of wavelengths, from a periodogram whose borders fade."""
    n = heights.shape
    window = np.sqrt(np.outer(np.hanning(n[0]), np.hanning(n[1])))
    power = np.abs(np.fft.fft2((heights - heights.mean()) * window)) ** 2 / (window ** 2).sum() / heights.size
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(n[0]), np.fft.fftfreq(n[1]), indexing="ij"))
    return [np.sqrt(power[(frequency >= 1 / a) & (frequency < 1 / b)].sum()) for a, b in zip(LONGEST, LONGEST[1:])]


def outermost(distance):
    """Where the surface is along the last axis, seen from its end [samples]; the middle where none is seen."""
    back = distance[..., ::-1]
    inner = np.maximum((back < 0).argmax(axis=-1), 1)[..., None]
    within, outside = (np.take_along_axis(back, inner - k, axis=-1)[..., 0] for k in (0, 1))
    seen = (within < 0) & (outside >= 0)
    at = inner[..., 0] - 1 + np.where(seen, outside, 0) / np.where(seen, outside - within, 1)
    return np.where(seen, distance.shape[-1] - 1 - at, np.nan)


class Model:
    """Distances [voxels], positive outside, over one box, and the surface's voxels with their places and normals."""

    def __init__(self, grid, low, high):
        self.low = np.array(low)
        dense = np.empty(tuple(np.array(high) - self.low + 1), np.float32)
        grid.copyToArray(dense, ijk=tuple(int(v) for v in low))
        self.distance = dense / grid.transform.voxelSize()[0]

    def surface(self, inside=None):
        """Places a voxel's width from the surface, moved onto it, and normals; without those outside `inside`."""
        d = self.distance
        voxels = np.argwhere(np.abs(d) < 0.5)
        if inside is not None:
            at = voxels + self.low
            voxels = voxels[np.all((at >= inside[0]) & (at <= inside[1]), axis=1)]
        slopes = np.stack([sample(np.gradient(d, axis=a), voxels.T) for a in range(3)], axis=1)
        lengths = np.maximum(np.linalg.norm(slopes, axis=1), 1e-6)
        normals = slopes / lengths[:, None]
        return voxels - (d[tuple(voxels.T)] / lengths)[:, None] * normals, normals


def sample(field, places):
    return ndimage.map_coordinates(field, places, order=1, mode="nearest")


def read(path, *others):
    """Models of several files over one box that holds them all."""
    grids = [next(g for g in vdb.readAll(str(p))[0] if g.name == "surface") for p in (path, *others)]
    boxes = [g.evalActiveVoxelBoundingBox() for g in grids]
    low = np.min([b[0] for b in boxes], axis=0) - 2
    high = np.max([b[1] for b in boxes], axis=0) + 2
    return [Model(g, low, high) for g in grids]


def height(textured, places, normals):
    """How deep below the plain surface the textured one is [voxels], and how that changes along the plain surface."""
    value = sample(textured.distance, places.T)
    slope = np.stack([sample(np.gradient(textured.distance, axis=a), places.T) for a in range(3)], axis=1)
    return value, slope - (slope * normals).sum(axis=1)[:, None] * normals


def spacing(value, slope, low, high):
    """Area over the length of lines, by the coarea formula over contours from low to high: two to a line [voxels]."""
    inside = (value > low) & (value < high)
    length = np.linalg.norm(slope[inside], axis=1).sum() / (high - low) / 2
    return len(value) / max(length, 1e-6)


def angles(places, slope, direction, sigma, shape):
    """Angle between lines and directions [degrees] and how much there is of a line, by the structure tensor."""
    at = tuple(np.clip(np.rint(places).astype(int), 0, np.array(shape) - 1).T)
    tensor = np.zeros((len(places), 3, 3))
    for i in range(3):
        for j in range(i, 3):
            field = np.zeros(shape, np.float32)
            np.add.at(field, at, slope[:, i] * slope[:, j])
            tensor[:, i, j] = tensor[:, j, i] = ndimage.gaussian_filter(field, sigma, truncate=2.5)[at]
    # The line runs along what is at right angles to the strongest change, within the surface.
    strongest = np.linalg.eigh(tensor)[1][:, :, 2]
    across = np.abs((strongest * direction).sum(axis=1))
    return np.degrees(np.arcsin(np.clip(across, 0, 1))), np.trace(tensor, axis1=1, axis2=2)


class Measurements:
    def __init__(self, arguments):
        self.program = str(pathlib.Path(arguments.build).resolve() / "tools/vdb_synth/vdb_synth")
        self.folder = pathlib.Path(arguments.build).resolve() / "quality" / "analogies"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.options = shlex.split(arguments.analogy)

    def tool(self, *words):
        result = subprocess.run([self.program, *map(str, words), "-q"], cwd=self.folder, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            raise RuntimeError(f"{' '.join(map(str, words))}: {result.stderr.strip()}")

    def make(self, name, kind, target, resolution, direction):
        """Makes pair, target and result; seconds taken and the report."""
        self.tool("make", kind, "A.vdb", "A2.vdb", "--resolution", 64)
        if "/" in target:
            self.tool("convert", SAMPLES / target, "-o", "B.vdb", "--resolution", resolution, "--half-width", 4)
        else:
            self.tool("make", target, "B.vdb", "--resolution", resolution)
        began = time.monotonic()
        self.tool("analogy", "A.vdb", "A2.vdb", "B.vdb", "-o", f"{name}.vdb", "--direction", direction, "--half-width", BAND,
                  "--write-directions", "--report", f"{name}.json", *self.options)
        seconds = time.monotonic() - began
        self.tool("render", f"{name}.vdb", "-o", f"{name}.png")
        return seconds, json.loads((self.folder / f"{name}.json").read_text(encoding="utf-8"))

    def blur(self, name, target, resolution, sigma):
        """--naive on densities: how much of a Gaussian blur, learnt from a sponge, is missed on another model."""
        self.tool("make", "sponge", "A.vdb", "--resolution", 64)
        if "/" in target:
            self.tool("convert", SAMPLES / target, "-o", "B.vdb", "--resolution", resolution)
        else:
            self.tool("make", target, "B.vdb", "--resolution", resolution)
        wide = int(np.ceil(4 * sigma)) + 4
        dense = {}
        for model in ("A", "B"):
            distance = np.pad(read(self.folder / f"{model}.vdb")[0].distance, wide, constant_values=3)
            dense[model] = np.clip(0.5 - distance / 2, 0, 1)
            dense[model + "2"] = ndimage.gaussian_filter(dense[model], sigma)
        for model, density in dense.items():
            grid = vdb.FloatGrid()
            grid.name, grid.gridClass = "density", vdb.GridClass.FOG_VOLUME
            grid.copyFromArray(density.astype(np.float32), tolerance=0)
            vdb.write(str(self.folder / f"{model}.density.vdb"), grid)
        began = time.monotonic()
        self.tool("analogy", "A.density.vdb", "A2.density.vdb", "B.density.vdb", "-o", f"{name}.vdb", "--naive", *self.options)
        seconds = time.monotonic() - began
        made = np.zeros(dense["B"].shape, np.float32)
        vdb.readAll(str(self.folder / f"{name}.vdb"))[0][0].copyToArray(made)
        rms = lambda a: np.sqrt(np.mean(np.square(a, dtype=np.float64)))
        print(f"{name:16} {seconds:5.1f} s  RMS(made - true) / RMS(true - before) {rms(made - dense['B2']) / rms(dense['B2'] - dense['B']):.3f}", flush=True)

    def cylinder(self, voxel):
        half, tall = RADIUS + BAND + 2, LENGTH // 2 + BAND + 2
        x, y, z = np.mgrid[-half:half + 1, -half:half + 1, -tall:tall + 1]
        distance = np.maximum(np.hypot(x, y) - RADIUS, np.abs(z) - LENGTH / 2)
        grid = vdb.FloatGrid(4 * voxel)
        grid.name, grid.gridClass, grid.transform = "surface", vdb.GridClass.LEVEL_SET, vdb.createLinearTransform(voxel)
        grid.copyFromArray((np.clip(distance, -4, 4) * voxel).astype(np.float32), ijk=(-half, -half, -tall), tolerance=0)
        vdb.write(str(self.folder / "B.vdb"), grid)

    def relief(self, name, picture, white, scale):
        """A picture's relief on a cylinder: deviation, quantiles and bands of wavelengths, next to the pair's."""
        gray = gray_of(SAMPLES / picture, scale) if "/" in picture else {"bricks": bricks, "grain": grain}[picture]()
        skimage.io.imsave(self.folder / f"{name}_picture.png", np.round(65535 * gray).astype(np.uint16), check_contrast=False)
        for file, height in (("A", 0.001), ("A2", white)):
            self.tool("convert", f"{name}_picture.png", "-o", f"{file}.vdb", "--height", height * scale, "--base", BASE * scale, "--voxel-size", scale)
        self.cylinder(scale)
        began = time.monotonic()
        self.tool("analogy", "A.vdb", "A2.vdb", "B.vdb", "-o", f"{name}.vdb", "--direction", "axis:z", "--half-width", BAND, *self.options)
        seconds = time.monotonic() - began
        self.tool("render", f"{name}.vdb", "-o", f"{name}.png")
        self.tool("convert", "A2.vdb", "-o", "A2w.vdb", "--half-width", BAND)
        print(f"{name:16} {seconds:5.1f} s  " + self.relief_measures(f"{name}.vdb", white, round(gray.shape[0] / scale)), flush=True)

    def relief_measures(self, made, white, size, margin=6):
        pair, made = (read(self.folder / file)[0] for file in ("A2w.vdb", made))
        inner = slice(margin, size - margin)
        wanted = outermost(pair.distance[-pair.low[0]:, -pair.low[1]:][inner, inner])
        angle = np.arange(0, 2 * np.pi, 1 / RADIUS)[:, None, None]
        along = np.arange(-LENGTH // 2 + 24, LENGTH // 2 - 24)[None, :, None]
        step = 0.25
        radius = np.arange(RADIUS - BASE, RADIUS + white + 4, step)
        places = np.stack(np.broadcast_arrays(np.cos(angle) * radius, np.sin(angle) * radius, along))
        found = outermost(sample(made.distance, places.reshape(3, -1) - made.low[:, None]).reshape(places.shape[1:])) * step
        of_wanted, of_found = (np.nanpercentile(h - np.nanmedian(h), np.arange(2, 99, 4)) for h in (wanted, found))
        known = [np.where(np.isnan(h), np.nanmean(h), h) for h in (found, wanted)]
        deviation = [h.std() for h in known]
        parts = ", ".join(f"{100 * (a / b - 1):+.0f} %" for a, b in zip(*map(bands, known)))
        return (f"deviation {deviation[0]:.2f} of {deviation[1]:.2f} voxels ({100 * (deviation[0] / deviation[1] - 1):+.0f} %)  "
                f"quantiles off by {100 * np.abs(of_found - of_wanted).mean() / deviation[1]:.0f} % of it  wavelengths {BANDS}: {parts}")

    def pair(self, margin=6):
        """Heights and slopes of the pair, `margin` voxels from where it is cut off."""
        for name in ("A", "A2"):  # what is made has a narrower band than its texture is deep
            self.tool("convert", f"{name}.vdb", "-o", f"{name}w.vdb", "--half-width", BAND)
        plain, textured = read(self.folder / "Aw.vdb", self.folder / "A2w.vdb")
        domain = vdb.readAll(str(self.folder / "A.vdb"))[0][0]["vdbsynth:domain"]
        corners = np.array([int(v) for v in domain.split(",")]).reshape(2, 3)
        inside = (corners[0] + margin, corners[1] - margin)
        places, normals = plain.surface(inside)
        return (*height(textured, places, normals), plain, textured, places, inside - plain.low)

    def run(self, name, kind, target, resolution, direction):
        seconds, report = self.make(name, kind, target, resolution, direction)
        plain, made = read(self.folder / "B.vdb", self.folder / f"{name}.vdb")
        places, normals = plain.surface()
        value, slope = height(made, places, normals)
        print(f"{name:16} {seconds:5.1f} s  " + getattr(self, kind)(name, report, plain, made, places, value, slope), flush=True)

    def grooves(self, name, report, plain, made, places, value, slope):
        of_pair, pair_slope = self.pair()[:2]
        deep = np.percentile(of_pair, 95)
        low, high = 0.3 * deep, 0.7 * deep
        expected = spacing(of_pair, pair_slope, low, high)
        directions = [g for g in vdb.readAll(str(self.folder / f"{name}.vdb"))[0] if g.name == "direction"][0]
        known = {item.min: item.value for item in directions.iterOnValues() if item.count == 1}
        rows = [known.get(tuple(int(v) for v in np.rint(p + plain.low))) for p in places]
        has = np.array([row is not None for row in rows])
        direction = np.array([row if row is not None else (1, 0, 0) for row in rows], float)
        far = np.ones(len(places), bool)
        for world in report["counts"]["singularity_places"]:
            at = np.array(directions.transform.worldToIndex(tuple(world))) - plain.low
            far &= np.linalg.norm(places - at, axis=1) > APART * expected
        angle, weight = angles(places, slope, direction, expected / 2, plain.distance.shape)
        use = far & has
        mean = np.average(angle[use], weights=weight[use])
        found = spacing(value[far], slope[far], low, high)
        return (f"angle {mean:4.1f} degrees  spacing {found:5.2f} of {expected:5.2f} voxels ({100 * (found / expected - 1):+.0f} %)  "
                f"depth {np.percentile(value[far], 95):4.1f} of {deep:4.1f}  excluded {100 * (1 - far.mean()):4.1f} % at {len(report['counts']['singularity_places'])} singularities")

    @staticmethod
    def openings(value, places, shape):
        """Parts of the plain surface that are open in the textured one: their sizes [voxels] and middles."""
        mask = np.zeros(shape, bool)
        at = np.rint(places[value > 0.5]).astype(int)
        mask[tuple(np.clip(at, 0, np.array(shape) - 1).T)] = True
        labels, count = ndimage.label(mask, np.ones((3, 3, 3)))
        sizes = np.bincount(labels[mask], minlength=count + 1)[1:]
        return sizes, np.array(ndimage.center_of_mass(mask, labels, range(1, count + 1)))

    def density(self, plain, places, value, sign=1):
        """Parts of the plain surface that the texture opens, or covers where sign is -1: how many were found, and a text."""
        of_pair, _, pair_plain, _, pair_places, inside = self.pair(0)
        sizes, middles = self.openings(sign * of_pair, pair_places, pair_plain.distance.shape)
        # An opening counts where its middle is, so that those that the pair's border cuts count in part, as they should.
        corners = inside + np.array([[8], [-8]])
        within = lambda at: np.all((at >= corners[0]) & (at <= corners[1]), axis=1)
        usual = np.median(sizes[within(middles)])
        count = int((within(middles) & (sizes >= usual / 4)).sum())
        of_made = self.openings(sign * value, places, plain.distance.shape)[0]
        of_made = of_made[of_made >= usual / 4]
        found, size = len(of_made), np.median(of_made)
        expected = count / within(pair_places).sum() * len(places)
        return found, (f"{'openings' if sign > 0 else 'bumps'} {found} of {expected:.0f} ({100 * (found / expected - 1):+.0f} %)  "
                       f"size {size:.0f} of {usual:.0f}  {count} in the pair  ")

    def pits(self, name, report, plain, made, places, value, slope):
        return self.density(plain, places, value)[1]

    def spikes(self, name, report, plain, made, places, value, slope):
        return self.density(plain, places, value, -1)[1]

    def holes(self, name, report, plain, made, places, value, slope):
        found, text = self.density(plain, places, value)
        before, after = (euler_number(m.distance < 0, connectivity=1) for m in (plain, made))
        return (text + f"Euler characteristic of the solid {before} to {after}: {(before - after) / max(found, 1):.2f} tunnels an opening")

    def dilation(self, name, report, plain, made, places, value, slope):
        expected = -self.pair()[0]
        error = -value - expected.mean()
        return (f"offset {-value.mean():.2f} of {expected.mean():.2f} voxels: mean error {error.mean():+.2f}, "
                f"root mean square {np.sqrt((error ** 2).mean()):.2f}, in the pair {expected.std():.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("rows", nargs="*")
    parser.add_argument("--analogy", default="", help="options to analogy, to choose defaults with")
    arguments = parser.parse_intermixed_args()
    measurements, failures = Measurements(arguments), 0
    for name, row in {**ROWS, **RELIEFS, **BLURS}.items():
        if arguments.rows and not any(word in name for word in arguments.rows):
            continue
        target = row[1] if name in ROWS else row[0]
        if "/" in target and not (SAMPLES / target).exists():
            print(f"{name:16} skipped: its sample is absent", flush=True)
            continue
        try:
            (measurements.blur if name in BLURS else measurements.relief if name in RELIEFS else measurements.run)(name, *row)
        except RuntimeError as error:
            print(f"{name:16} failed: {error}", flush=True)
            failures += 1
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
