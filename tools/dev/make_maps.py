#!/usr/bin/python3
"""Writes maps over a result of 128 x 128 x 64 voxels for pictures: make_maps.py OUT.vdb. Needs numpy and pyopenvdb.

`label` is 1 in a cylinder in the middle, `scale` grows from 0.5 to 1.5 along x."""
import sys

import numpy
import pyopenvdb


def grid_of(values, name):
    grid = pyopenvdb.FloatGrid()
    grid.copyFromArray(values.astype(numpy.float32), tolerance=0)
    grid.name = name
    return grid


def main(path):
    x, y, _ = numpy.meshgrid(numpy.arange(128), numpy.arange(128), numpy.arange(64), indexing="ij")
    label = (x - 63.5) ** 2 + (y - 63.5) ** 2 < 38 ** 2
    pyopenvdb.write(path, grids=[grid_of(label, "label"), grid_of(0.5 + x / 127, "scale")])


if __name__ == "__main__":
    main(*sys.argv[1:])
