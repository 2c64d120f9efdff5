#!/usr/bin/python3
"""Makes a fog volume for pictures, the same for everyone: make_cloud.py OUT.vdb. Needs numpy and pyopenvdb."""
import sys

import numpy
import pyopenvdb


def main(path):
    side = 128
    z, y, x = numpy.meshgrid(*[numpy.linspace(-1, 1, side)] * 3, indexing="ij")
    generator = numpy.random.default_rng(7)
    density = numpy.full((side,) * 3, -1.0)
    # Puffs along a rising, widening column.
    for i in range(70):
        t = i / 69
        centre = generator.normal(0, 0.06 + 0.17 * t, 3) + numpy.array([0.25 * t * t, 0, -0.75 + 1.35 * t])
        radius = 0.10 + 0.16 * t + 0.05 * generator.random()
        distance = numpy.sqrt((z - centre[0]) ** 2 + (y - centre[1]) ** 2 + (x - centre[2]) ** 2)
        density = numpy.maximum(density, 1 - distance / radius)
    # Waves of falling length break the puffs up.
    for octave in range(4):
        for _ in range(5):
            way, phase = generator.normal(0, 1, 3) * 7 * 2 ** octave, generator.random() * 7
            density += 0.055 * 0.62 ** octave * numpy.sin(way[0] * z + way[1] * y + way[2] * x + phase)
    grid = pyopenvdb.FloatGrid()
    # The array's first axis becomes x.
    grid.copyFromArray(numpy.clip(density * 2.5, 0, 1).astype(numpy.float32), tolerance=0)
    grid.name, grid.gridClass = "density", pyopenvdb.GridClass.FOG_VOLUME
    pyopenvdb.write(path, grids=[grid])


if __name__ == "__main__":
    main(*sys.argv[1:])
