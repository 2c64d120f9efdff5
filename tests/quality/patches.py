#!/usr/bin/python3
"""Measures patches: borders, rings, seconds and memory. Prints the tables of docs/patches.md.
Usage: patches.py BUILD_FOLDER [TABLE...] [--kind KIND]... [--size 4x,4x] [--method NAME]
Tables: borders (gaps, spacing and normals where patches meet), rings (of a chainmail, closed, single and linked), seconds (by stage, points a second, memory),
growth (16 times the area beside 4 times), large (a chainmail of millions of points); default all but large. Or: patches.py --sheet SHEET.ply EXEMPLAR.ply, the
borders of one sheet. Needs numpy; with scipy it is faster. Samples are those of VDBSYNTH_SAMPLES, default ../shared/data.

Of a sheet's .ply with normals and `patch`, the number of the patch that brought a point; lengths count in spacings, the median distance to the nearest point:
- Gap: of two neighbours p, q of different patches, their step along the surface's normal, |(p - q).(n_p + n_q)| / |n_p + n_q|, which is 0 on a plane and on a
  sphere. Beside it the same within patches, which is what curvature and the sampling make.
- Spacing: of every point the mean distance to its six nearest; its deviation over its mean, beside the exemplar's. At borders: its mean over that elsewhere,
  which is over 1 where patches leave a strip empty.
- Jump: angle between the normals of neighbours over their distance, across borders over within patches."""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import rings
from ply_data import pairs_within, read_ply

try:
    from scipy.spatial import cKDTree
except ImportError:
    cKDTree = None

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SAMPLES = pathlib.Path(os.environ.get("VDBSYNTH_SAMPLES") or SOURCE.parent / "shared" / "data")
KINDS = {kind: ["make", kind] for kind in ("bumps", "chainmail", "weave", "flowers")}
KINDS.update({"brick": ["convert", str(SAMPLES / "textures" / "brick.png"), "--height", "20", "--resolution", "128", "--as", "points"],
              "gravel": ["convert", str(SAMPLES / "textures" / "gravel.png"), "--height", "20", "--resolution", "128", "--as", "points"],
              "bark": ["convert", str(SAMPLES / "textures" / "vistex-Bark-11.png"), "--height", "20", "--resolution", "128", "--as", "points"]})
NEIGHBOURS = 6
MEET = 2.0  # [spacings] farther points are no neighbours
WANTED = {"gap": 0.05, "spacing": 0.2, "jump": 1.1, "whole": 0.98, "partners": 0.95, "rate": 300000, "growth": (3.6, 4.4), "large": 10.0}
# Of these stages' names, those that read and prepare the exemplar, and those that write.
PREPARED, WRITTEN = ("reading", "distances of the exemplar", "level set to points"), ("writing",)


def neighbours(points, chosen, count, reach):
    """Distances (chosen x count) to the nearest others, nearest first; infinite beyond `reach`."""
    if cKDTree is not None:
        return cKDTree(points).query(points[chosen], count + 1, distance_upper_bound=reach)[0][:, 1:]
    found = [(a, b) for a, b in pairs_within(points, reach)]
    a = np.concatenate([p[0] for p in found] + [p[1] for p in found])
    b = np.concatenate([p[1] for p in found] + [p[0] for p in found])
    far = np.linalg.norm(points[a] - points[b], axis=1)
    order = np.lexsort((far, a))
    a, far = a[order], far[order]
    first = np.searchsorted(a, np.arange(len(points)))
    rank = np.arange(len(a)) - first[a]
    near = np.full((len(points), count), np.inf)
    near[a[rank < count], rank[rank < count]] = far[rank < count]
    return near[chosen]


def within_ends(points, border):
    """True for the points farther than `border` from the ends of the sheet, along its two longer sides."""
    low, high = points.min(0), points.max(0)
    axes = [axis for axis in range(3) if axis != np.argmin(high - low)]
    return np.all([(points[:, a] > low[a] + border) & (points[:, a] < high[a] - border) for a in axes], axis=0)


def spacings(ply, spacing, most=50000):
    """The mean distance to their six nearest of up to `most` points, and their numbers; those near the ends of the sheet left out."""
    chosen = np.nonzero(within_ends(ply.points, 4 * spacing))[0]
    chosen = chosen[::max(1, len(chosen) // most)]
    near = neighbours(ply.points, chosen, NEIGHBOURS, 8 * spacing).mean(1)
    return near[np.isfinite(near)], chosen[np.isfinite(near)]


def spacing_variation(ply, spacing):
    near, _ = spacings(ply, spacing)
    return float(near.std() / near.mean()) if len(near) else 0.0


def at_borders(ply, spacing):
    """True for the points with one of another patch within 4 spacings, which faces the same way."""
    patch, found = np.rint(ply.columns["patch"]), np.zeros(len(ply.points), bool)
    for a, b in pairs_within(ply.points, 2 * MEET * spacing):
        across = (patch[a] != patch[b]) & ((ply.normals[a] * ply.normals[b]).sum(1) > 0)
        found[a[across]] = found[b[across]] = True
    return found


def steps_and_angles(ply, spacing):
    """Of neighbours that face the same way: the step along the normal and the distance [spacings], the angle between their normals [radians], and whether
    their patches differ."""
    patch = np.rint(ply.columns["patch"]).astype(np.int64)
    parts = []
    for a, b in pairs_within(ply.points, MEET * spacing):
        facing = (ply.normals[a] * ply.normals[b]).sum(1)
        kept = facing > 0
        a, b, facing = a[kept], b[kept], facing[kept]
        between = ply.points[a] - ply.points[b]
        both = ply.normals[a] + ply.normals[b]
        step = np.abs((between * both).sum(1)) / np.linalg.norm(both, axis=1) / spacing
        parts.append((step, np.linalg.norm(between, axis=1) / spacing, np.where(facing < 1 - 1e-12, np.arccos(np.minimum(facing, 1)), 0), patch[a] != patch[b]))
    return [np.concatenate(part) for part in zip(*parts)]


def borders(sheet, exemplar=None):
    """The numbers of a sheet: `pairs` that meet at borders, `gap` and `gap_inside`, `gap_worst` (of the worst hundredth), `spacing`, `spacing_of_exemplar`,
    `spacing_at_borders` and `jump`. @raise ValueError (no normals, no patches)"""
    if sheet.normals is None or "patch" not in sheet.columns:
        raise ValueError("the sheet has no normals or no attribute \"patch\"")
    spacing = rings.spacing(sheet.points)
    step, far, angle, across = steps_and_angles(sheet, spacing)
    result = {"points": len(sheet.points), "patches": len(np.unique(sheet.columns["patch"])), "pairs": int(across.sum()),
              "spacing": spacing_variation(sheet, spacing)}
    if exemplar is not None:
        result["spacing_of_exemplar"] = spacing_variation(exemplar, rings.spacing(exemplar.points))
    near, numbers = spacings(sheet, spacing)
    border = at_borders(sheet, spacing)[numbers]
    if border.any() and not border.all():
        result["spacing_at_borders"] = float(near[border].mean() / near[~border].mean())
    if not across.any() or across.all():
        return result
    result.update(gap=float(step[across].mean()), gap_inside=float(step[~across].mean()), gap_worst=float(np.quantile(step[across], 0.99)))
    turn = [angle[side].sum() / far[side].sum() for side in (across, ~across)]
    result["jump"] = float(turn[0] / turn[1]) if turn[1] > 0 else float("inf") if turn[0] > 0 else 1.0
    return result


def row(*cells):
    print("| " + " | ".join(str(c) for c in cells) + " |", flush=True)


def header(*cells):
    print()
    row(*cells)
    print("|" + "---|" * len(cells))


def missed(holds):
    return "" if holds else " (missed)"


class Programs:
    def __init__(self, build, folder, size, method):
        self.tool = str(pathlib.Path(build) / "tools" / "vdb_synth" / "vdb_synth")
        self.folder, self.size = pathlib.Path(folder), size
        self.words = ["--method", method] if method else []
        self.done = {}

    def run(self, *words):
        result = subprocess.run([self.tool, *map(str, words), "-q", "--force"], capture_output=True, text=True, check=False)
        if result.returncode != 0:
            raise RuntimeError(result.stderr.strip())

    def exemplar(self, kind, *words):
        path = self.folder / f"{kind}{len(words) and ''.join(words)}.ply"
        if not path.exists():
            made = KINDS[kind]
            self.run(*made[:2], *(["-o", path] if made[0] == "convert" else [path]), *made[2:], *words)
        return path

    def sheet(self, kind, size=None, *words):
        """Of an exemplar: paths of it and of its sheet, and the report of the run; made once."""
        key = (kind, size or self.size, words)
        if key not in self.done:
            source, out, report = self.exemplar(kind), self.folder / f"sheet{len(self.done)}.ply", self.folder / "r.json"
            self.run("patch", source, "-o", out, "--size", key[1], "--report", report, *self.words, *words)
            self.done[key] = (source, out, json.loads(report.read_text()))
        return self.done[key]


def seconds_of(report, but=()):
    """Seconds of a run without the stages whose names begin so."""
    return report["seconds"] - sum(stage["seconds"] for stage in report["stages"] if stage["name"].startswith(tuple(but)))


def table_borders(programs, kinds):
    header("exemplar", "points", "patches", "mean gap at borders (spacings)", "within patches", "worst hundredth", "spacing's variation", "the exemplar's",
           "spacing at borders", "normal jump")
    for kind in kinds:
        source, out, _ = programs.sheet(kind)
        n = borders(read_ply(out), read_ply(source))
        if "gap" not in n:
            row(kind, n["points"], n["patches"], "one patch" if n["patches"] == 1 else "patches that do not meet (missed)")
            continue
        even = abs(n["spacing"] / n["spacing_of_exemplar"] - 1) <= WANTED["spacing"]
        row(kind, n["points"], n["patches"], f"{n['gap']:.3f}{missed(n['gap'] < WANTED['gap'])}", f"{n['gap_inside']:.3f}", f"{n['gap_worst']:.2f}",
            f"{n['spacing']:.3f}{missed(even)}", f"{n['spacing_of_exemplar']:.3f}", f"{n.get('spacing_at_borders', 1):.2f}",
            f"{n['jump']:.2f}{missed(n['jump'] <= WANTED['jump'])}")


def ring_row(name, path):
    n = rings.measure(read_ply(path))
    row(name, f"{n['counted']:.0f}", *(f"{100 * n[key]:.1f} %{missed(n[key] >= WANTED.get(key, 0))}" for key in ("closed", "single", "whole", "partners", "flat")))


def table_rings(programs, _):
    header("sheet", "rings away from the ends", "closed", "single", "closed and single", "right partners", "flat")
    source, out, _ = programs.sheet("chainmail")
    ring_row("the exemplar", source)
    ring_row(programs.size, out)


def table_seconds(programs, kinds):
    header("exemplar", "points in", "points out", "reading", "by stage", "seconds", "points a second", "peak memory")
    for kind in kinds:
        source, out, report = programs.sheet(kind)
        stages = ", ".join(f"{s['name']} {s['seconds']:.1f}" for s in report["stages"] if not s["name"].startswith(PREPARED + WRITTEN))
        count, seconds = len(read_ply(out).points), report["seconds"]
        rate = count / max(seconds_of(report, PREPARED), 1e-9)
        row(kind, len(read_ply(source).points), count, f"{seconds - seconds_of(report, PREPARED):.1f}", stages, f"{seconds:.1f}",
            f"{rate:.0f}{missed(rate >= WANTED['rate'])}", f"{report['peak_bytes'] / 2**20:.0f} MiB")


def table_growth(programs, kinds):
    header("exemplar", "2x,2x: seconds", "4x,4x", "times", "without what is prepared and written")
    for kind in kinds:
        small, large = (programs.sheet(kind, size)[2] for size in ("2x,2x", "4x,4x"))
        times = seconds_of(large, PREPARED + WRITTEN) / max(seconds_of(small, PREPARED + WRITTEN), 1e-9)
        low, high = WANTED["growth"]
        row(kind, f"{small['seconds']:.1f}", f"{large['seconds']:.1f}", f"{large['seconds'] / small['seconds']:.1f}", f"{times:.2f}{missed(low <= times <= high)}")


def table_large(programs, _):
    header("chainmail", "points out", "seconds", "points a second", "peak memory")
    source, out, report = programs.sheet("chainmail", "8x,8x")
    count = len(read_ply(out).points)
    row(f"{len(read_ply(source).points)} points in", count, f"{report['seconds']:.1f}", f"{count / report['seconds']:.0f}", f"{report['peak_bytes'] / 2**20:.0f} MiB")
    header("sheet", "rings away from the ends", "closed", "single", "closed and single", "right partners", "flat")
    ring_row("8x,8x", out)


TABLES = {"borders": table_borders, "rings": table_rings, "seconds": table_seconds, "growth": table_growth, "large": table_large}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("tables", nargs="*", metavar="table", help=", ".join(TABLES))
    parser.add_argument("--kind", action="append", choices=KINDS)
    parser.add_argument("--size", default="4x,4x")
    parser.add_argument("--method")
    parser.add_argument("--sheet", action="store_true", help="measure SHEET.ply beside EXEMPLAR.ply")
    a = parser.parse_args()
    if a.sheet:
        print(json.dumps(borders(read_ply(a.build), read_ply(a.tables[0]) if a.tables else None)))
        return
    unknown = set(a.tables) - set(TABLES)
    if unknown:
        parser.error(f"no such table: {', '.join(sorted(unknown))}")
    with tempfile.TemporaryDirectory() as folder:
        programs = Programs(a.build, folder, a.size, a.method)
        for table in a.tables or [name for name in TABLES if name != "large"]:
            try:
                TABLES[table](programs, a.kind or list(KINDS))
            except RuntimeError as error:
                print(f"{table}: {error}", file=sys.stderr)


if __name__ == "__main__":
    main()
