#!/usr/bin/python3
"""Counts the rings of a chainmail: how many are closed, single and linked as the lattice of `vdb_synth make chainmail` says.
Usage: rings.py MODEL [--tool VDB_SYNTH] [--border W] [--around x|y|z] [--json]
MODEL is a .ply (mesh or points), or anything that `vdb_synth convert` makes a mesh of.

- A ring is a connected component with the circle that fits its surface as a torus. Of points, neighbours within 2.2 times the median spacing whose normals
  differ by under 90 degrees are connected.
- It is closed if no gap over 5 degrees is left around that circle, and single if its points are as far from the circle as those of a tube and its area is
  that of a torus.
- Two rings are linked if Gauss's integral over both circles, 64 segments each, is over a half.
- A flat ring has its axis along the normal of the sheet, the plane of the nearest centres. It must have 4 partners, an upright one 2.
Shares are of the rings' area and count only what is farther than --border from the ends of the sheet (default 2.25 times the radius of the flat rings, 0.9
cells); --around says the axis of a sleeve, which has ends along that axis only. Needs numpy."""
import argparse
import json

import numpy as np

from ply_data import joined, load, pairs_within

GAP = 5.0  # [degrees]
SEGMENTS = 64
NEAR = 2.2  # [median spacings]
SCATTER = 0.15  # of the radius: how far from an even tube the points of a single ring may be, root mean square
AREA = (0.7, 1.3)  # of a torus, of a single ring
LEAST_POINTS = 12


class Ring:
    """`area` (of points: their number) and, with `fits`, the circle."""

    def __init__(self, points, corners, area):
        self.area, self.middle = area, points.mean(0)
        self.centre, self.axis, self.radius, self.tube, self.scatter = fitted(points)
        self.fits = len(points) >= LEAST_POINTS and self.scatter < SCATTER * self.radius
        self.gap = angular_gap(corners, self.centre, self.axis) if self.fits else 360.0
        self.closed = self.gap <= GAP
        self.single = False
        self.partners = 0
        self.flat = False

    @property
    def whole(self):
        return self.closed and self.single

    def torus_area(self):
        return 4 * np.pi ** 2 * self.radius * self.tube

    def circle(self):
        u, v = across(self.axis)
        turn = np.arange(SEGMENTS + 1) * 2 * np.pi / SEGMENTS
        return self.centre + self.radius * (np.cos(turn)[:, None] * u + np.sin(turn)[:, None] * v)


def across(axis):
    u = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    u /= np.linalg.norm(u)
    return u, np.cross(axis, u)


def fitted(points, most=400, rounds=8):
    """The torus whose surface is nearest to the points: centre, axis, radius, radius of the tube, and the root mean square distance from it."""
    points = points[::max(1, len(points) // most)]
    centre = points.mean(0)
    away = points - centre
    axis = np.linalg.svd(away, full_matrices=False)[2][2] if len(points) > 2 else np.array([0, 0, 1.0])
    # A circle through the points, in the plane of least variance; it finds the centre of an arc.
    u, v = across(axis)
    plane = np.stack([away @ u, away @ v], 1)
    solved = np.linalg.lstsq(np.c_[2 * plane, np.ones(len(plane))], (plane ** 2).sum(1), rcond=None)[0]
    centre = centre + solved[0] * u + solved[1] * v
    radius = np.sqrt(max(solved[2] + solved[0] ** 2 + solved[1] ** 2, 1e-12))
    tube = 0.0
    for _ in range(rounds):  # Gauss and Newton
        u, v = across(axis)
        away = points - centre
        height, x, y = away @ axis, away @ u, away @ v
        out = np.maximum(np.hypot(x, y), 1e-12)
        far = np.maximum(np.hypot(out - radius, height), 1e-12)
        tube = far.mean()
        a, b = (out - radius) / far, height / far
        cosine, sine = x / out, y / out
        # By the centre along u, v and the axis, by the axis's tilts towards u and v, by both radii.
        slopes = np.stack([-a * cosine, -a * sine, -b, b * x - a * cosine * height, b * y - a * sine * height, -a, -np.ones(len(a))], 1)
        step = np.linalg.lstsq(slopes, -(far - tube), rcond=None)[0]
        size = np.abs(step).max()
        if not np.isfinite(size) or size > radius:
            break
        centre = centre + step[0] * u + step[1] * v + step[2] * axis
        axis = axis + step[3] * u + step[4] * v
        axis /= np.linalg.norm(axis)
        radius += step[5]
        if size < 1e-7 * radius:
            break
    away = points - centre
    height = away @ axis
    far = np.hypot(np.linalg.norm(away - height[:, None] * axis, axis=1) - radius, height)
    return centre, axis, radius, far.mean(), far.std()


def angular_gap(corners, centre, axis):
    """The widest gap [degrees] around a circle between what `corners` (n x k x 3) cover: points (k = 1) nothing, triangles from corner to corner."""
    u, v = across(axis)
    away = corners - centre
    angle = np.degrees(np.arctan2(away @ v, away @ u))
    first = angle[:, 0]
    span = (angle - first[:, None] + 180) % 360 - 180
    low, high = first + span.min(1), first + span.max(1)
    turns = np.floor(low / 360) * 360
    low, high = low - turns, high - turns
    order = np.argsort(low)
    low, reach = low[order], np.maximum.accumulate(high[order])
    gaps = low[1:] - reach[:-1]
    # Behind the last one comes the first again; what reaches over 360 covers the beginning.
    last = low[0] + 360 - reach[-1]
    covered = reach[-1] - 360
    gaps = np.minimum(gaps, low[1:] - covered)
    return max(float(gaps.max(initial=0)), float(last), 0.0)


def linking(a, b):
    """Gauss's integral over two closed polylines: the linking number of two circles within 0.01 unless they nearly touch."""
    da, db = np.diff(a, axis=0), np.diff(b, axis=0)
    between = (a[:-1] + da / 2)[:, None] - (b[:-1] + db / 2)[None]
    volume = (between * np.cross(da[:, None], db[None])).sum(2)
    return float((volume / np.linalg.norm(between, axis=2) ** 3).sum() / (4 * np.pi))


def components(ply):
    """Lists of point numbers, and of triangle numbers (of points: none), by component."""
    if len(ply.triangles):
        _, same = np.unique(ply.points, axis=0, return_inverse=True)
        same = same.reshape(-1)
        corner = same[ply.triangles]
        label = joined(len(ply.points), [(corner[:, 0], corner[:, 1]), (corner[:, 1], corner[:, 2])])[same]
        label = np.unique(label, return_inverse=True)[1]
        return groups(label), groups(label[ply.triangles[:, 0]], label.max() + 1)
    if ply.normals is None:
        raise ValueError("points without normals; `vdb_synth convert` estimates them")
    reach = NEAR * spacing(ply.points)
    faced = ((a, b, (ply.normals[a] * ply.normals[b]).sum(1) > 0) for a, b in pairs_within(ply.points, reach))
    label = joined(len(ply.points), [(a[same], b[same]) for a, b, same in faced])
    return groups(label), None


def groups(label, count=None):
    order = np.argsort(label, kind="stable")
    ends = np.searchsorted(label[order], np.arange((label.max() + 1 if count is None else count) + 1))
    return [order[ends[i]:ends[i + 1]] for i in range(len(ends) - 1)]


def spacing(points, sample=2000):
    """The median distance to the nearest other point, of a sample."""
    size = np.ptp(points, axis=0)
    radius = np.sqrt(max(size[0] * size[1], size[1] * size[2], size[0] * size[2]) / len(points)) + 1e-12
    chosen = np.arange(0, len(points), max(1, len(points) // sample))
    nearest = np.full(len(points), np.inf)
    while not np.isfinite(np.median(nearest[chosen])):
        for a, b in pairs_within(points, radius):
            far = np.linalg.norm(points[a] - points[b], axis=1)
            np.minimum.at(nearest, a, far)
            np.minimum.at(nearest, b, far)
        radius *= 1.5
    return float(np.median(nearest[chosen]))


def rings_of(ply):
    """All components as rings."""
    points, faces = components(ply)
    corners = ply.points[ply.triangles] if faces is not None else None
    rings = []
    for i, numbers in enumerate(points):
        if len(numbers) < 3:
            continue
        if faces is None:
            rings.append(Ring(ply.points[numbers], ply.points[numbers][:, None], float(len(numbers))))
            continue
        own = corners[faces[i]]
        area = np.linalg.norm(np.cross(own[:, 1] - own[:, 0], own[:, 2] - own[:, 0]), axis=1).sum() / 2
        rings.append(Ring(ply.points[numbers], own, area))
    # What a point counts, by the median of the rings that close.
    if faces is None:
        sizes = [ring.torus_area() / ring.area for ring in rings if ring.closed]
        for ring in rings:
            ring.area *= np.median(sizes) if sizes else 1
    for ring in rings:
        ring.single = ring.fits and AREA[0] < ring.area / max(ring.torus_area(), 1e-12) < AREA[1]
    return rings


def count_partners(rings):
    """Sets `partners` and `flat` of those with a circle. @return number of links"""
    rings = [ring for ring in rings if ring.fits]
    if not rings:
        return 0
    centres = np.array([ring.centre for ring in rings])
    circles = [ring.circle() for ring in rings]
    links = 0
    for a, b in pairs_within(centres, 2 * max(ring.radius for ring in rings)):
        for i, j in zip(a, b):
            near = np.linalg.norm(centres[i] - centres[j]) < rings[i].radius + rings[j].radius
            if near and abs(linking(circles[i], circles[j])) > 0.5:
                rings[i].partners += 1
                rings[j].partners += 1
                links += 1
    for i, ring in enumerate(rings):
        near = np.argsort(((centres - centres[i]) ** 2).sum(1))[:13]
        up = np.linalg.svd(centres[near] - centres[near].mean(0))[2][2] if len(near) > 3 else np.array([0, 0, 1.0])
        ring.flat = abs(ring.axis @ up) > 0.7
    return links


def inside(rings, points, border, around):
    """True for the rings that are farther than `border` from the ends of the sheet."""
    low, high = points.min(0), points.max(0)
    axes = [around] if around is not None else [axis for axis in range(3) if axis != np.argmin(high - low)]
    centres = np.array([ring.centre if ring.fits else ring.middle for ring in rings])
    return np.all([(centres[:, a] > low[a] + border) & (centres[:, a] < high[a] - border) for a in axes], axis=0)


def measure(ply, border=None, around=None):
    """The numbers that main prints. `around`: 0, 1 or 2, the axis of a sleeve."""
    rings = rings_of(ply)
    links = count_partners(rings)
    whole = [ring for ring in rings if ring.whole]
    result = {"components": len(rings), "whole_rings": len(whole), "links": links}
    if not whole:
        return dict(result, border=0.0, counted=0.0, flat=0.0, closed=0.0, single=0.0, whole=0.0, partners=0.0)
    flat = [ring.radius for ring in whole if ring.flat] or [ring.radius for ring in whole]
    border = 2.25 * float(np.median(flat)) if border is None else border
    typical = np.median([ring.area for ring in whole])
    kept = [ring for ring, within in zip(rings, inside(rings, ply.points, border, around)) if within]
    # What is no ring counts as many as its area makes.
    weight = np.array([1.0 if ring.whole else ring.area / typical for ring in kept])

    def share(holds):
        return float((weight * [bool(holds(ring)) for ring in kept]).sum() / weight.sum()) if len(kept) else 0.0

    return dict(result, border=border, counted=float(weight.sum()), flat=share(lambda r: r.flat), closed=share(lambda r: r.closed),
                single=share(lambda r: r.single), whole=share(lambda r: r.whole),
                partners=share(lambda r: r.whole and r.partners == (4 if r.flat else 2)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model")
    parser.add_argument("--tool", default="vdb_synth")
    parser.add_argument("--border", type=float)
    parser.add_argument("--around", choices="xyz")
    parser.add_argument("--json", action="store_true")
    a = parser.parse_args()
    result = measure(load(a.model, a.tool), a.border, "xyz".index(a.around) if a.around else None)
    if a.json:
        print(json.dumps(result))
        return
    print(f"components: {result['components']}, whole rings: {result['whole_rings']}, links: {result['links']}")
    print(f"farther than {result['border']:.4g} from the ends: {result['counted']:.1f} rings")
    for name, wanted in (("closed", ""), ("single", ""), ("whole", "98 % wanted"), ("partners", "95 % wanted"), ("flat", "a third expected")):
        print(f"{name}: {100 * result[name]:.1f} %" + (f" ({wanted})" if wanted else ""))


if __name__ == "__main__":
    main()
