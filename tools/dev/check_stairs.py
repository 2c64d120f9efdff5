#!/usr/bin/python3
"""Checks the stairs: no room includes a room above it, OpenVDB and the other heavy libraries are seen
only where they may be, and messages of the library name no flags of the command line. Prints each breach as FILE:LINE and exits with 1 if there is one."""
import pathlib
import re
import sys

# A room may include itself and what stands in its list.
BELOW = {}
for room, direct in [
    ("base", []), ("math", ["base"]), ("geometry", ["math"]), ("points", ["geometry"]), ("grid", ["geometry"]),
    ("distance", ["grid"]), ("solid", ["distance"]), ("raster", ["distance"]), ("map", ["grid"]),
    ("io", ["raster", "solid"]), ("procedural", ["distance"]), ("surface", ["grid", "points"]), ("search", ["io"]),
    ("coordinates", ["search", "surface"]), ("patch", ["coordinates"]), ("texture", ["coordinates", "map"]), ("relief", ["coordinates", "map", "distance"]),
    ("synth", ["search", "map"]), ("analogy", ["search", "surface", "map"]), ("measure", ["relief", "synth"]),
    ("vdb", ["io", "map", "solid"]), ("render", ["vdb"]),
    ("pipeline", ["measure", "synth", "analogy", "patch", "texture", "relief", "procedural", "render"]), ("tools", ["pipeline"]), ("python", ["pipeline"]),
]:
    BELOW[room] = {room}.union(*[BELOW[d] for d in direct]) if direct else {room}

# Which rooms may see which third party.
ALLOWED = {
    "openvdb/": {"vdb", "render", "pipeline", "python"}, "pybind11/": {"python"}, "boost/python": {"python"}, "tbb/": {"base"}, "xxhash.h": {"base"}, "png.h": {"io"},
    "tiny_obj_loader.h": {"io"}, "tiffio.h": {"io"}, "jpeglib.h": {"io"}, "Imf": {"io"}, "pugixml.hpp": {"io"}, "tiny_gltf.h": {"io"}, "zlib.h": {"io"}, "nanoflann.hpp": {"geometry"}, "flann/": {"search"}, "Eigen/": {"math", "geometry", "patch"}, "boost/graph/": {"math"}, "boost/program_options": {"tools"}, "nlohmann/": {"io", "tools"}, "yaml-cpp/": {"tools"},
}
ONE_FILE = {"png.h", "zlib.h", "nanoflann.hpp", "flann/", "tiny_obj_loader.h", "tiffio.h", "jpeglib.h", "Imf", "tiny_gltf.h", "xxhash.h", "boost/graph/", "boost/program_options", "boost/python", "yaml-cpp/"}

# The C library's own, of which the last bit differs between processors: results are to be the same everywhere.
# Rounded exactly, and so allowed: sqrt, floor, ceil, round, fmod, ldexp, frexp and the like.
INEXACT = re.compile(r"(?<![\w.>])(?:std::)?((?:sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|asinh|acosh|atanh|exp|exp2|expm1|log|log2"
                     r"|log10|log1p|pow|hypot|cbrt|erf|erfc|tgamma|lgamma)[fl]?|polar|sincos)\(|\b(computeDirect)\(")
INEXACT_ALLOWED = {
    "libvdbsynth/math/line_transform.cpp": "names them for kissfft, and asks math/trigonometry",
}


def inexact(root):
    """Calls of such functions in the library."""
    found = []
    for path in sorted([*root.glob("libvdbsynth/**/*.h"), *root.glob("libvdbsynth/**/*.cpp")]):
        relative = str(path.relative_to(root))
        if relative in INEXACT_ALLOWED:
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = INEXACT.search(re.sub(r'//.*|"(\\.|[^"\\])*"', "", line))
            if match:
                found.append(f"{relative}:{number}: {match.group(1) or match.group(2)} gives other bits elsewhere; use math/trigonometry")
    return found


# A method is one header with its options and result, and what those are made of: of texturing ten, as its samples, targets and
# coordinates are types of their own; of relief five, as extraction gives its base, radii and statistics as well. Directions are an option of five methods.
MOST_PUBLIC = 55
MOST_HEADERS = 13  # in a folder

# Headers without a test of their own: plain data, or tested with what uses them, which is named.
UNTESTED = {
    "analogy/analogy_options.h": "plain data; pipeline/validation_test",
    "base/parallel_sort.h": "base/parallel_test",
    "measure/measures.h": "plain data",
    "procedural/kinds.h": "procedural/exemplar_test",
    "raster/raster_field.h": "plain data",
    "texture/textured_sites.h": "plain data",
    "raster/raster_options.h": "plain data; pipeline/validation_test",
    "search/block_index_data.h": "search/block_index_test",
    "synth/synthesis_options.h": "plain data; pipeline/validation_test",
    "vdb/vdb_fwd.h": "forward declarations",
}


def nameless(root):
    """A .cpp file has a header, or is named after the one that declares it: NAME.cpp or NAME_part.cpp for NAME.h."""
    found = []
    for source in sorted((root / "libvdbsynth").rglob("*.cpp")):
        names = {h.stem.removesuffix("_steps") for h in source.parent.glob("*.h")}
        parts = source.stem.split("_")
        if not any("_".join(parts[:n]) in names for n in range(len(parts), 0, -1)):
            found.append(f"{source.relative_to(root)}: has no header, and is named after none")
    return found


def untested(root):
    """Every header of the library has a test in the mirrored folder, named after it."""
    found = []
    for header in sorted((root / "libvdbsynth").rglob("*.h")):
        relative = header.relative_to(root / "libvdbsynth")
        if header.name.endswith("_steps.h") or str(relative) in UNTESTED:
            continue
        test = root / "tests" / relative.parent / (header.stem + "_test.cpp")
        others = list(test.parent.glob(header.stem + "_*_test.cpp")) if test.parent.exists() else []
        if not test.exists() and not others:
            found.append(f"libvdbsynth/{relative}: has no {test.relative_to(root)}")
    return found

# The place of a voxel in an array, its inverse and the neighbours have one home, math/lattice.h. Here, over lines:
# (x * sizeY + y) * sizeZ + z typed out, a loop in a loop in a loop from -1 to 1, and the 27 steps decoded from a number.
_AROUND = r"for \((?:int|auto) \w+ = -1; \w+ <= 1; (?:\+\+\w+|\w+\+\+)\)\s*\{?\s*"
RETYPED = {
    "a linear index; use latticeIndex":
        re.compile(r"\)\s*\*\s*std::(?:size_t|uint64_t)\([\w.()]+\.z\)\s*\+\s*std::(?:size_t|uint64_t)\("),
    "a loop over neighbours; use kAllNeighbours, or forEachVoxel over a box grown by 1": re.compile(_AROUND * 3),
    "a step decoded from a number; use kAllNeighbours, or forEachVoxel over a box grown by 1":
        re.compile(r"/\s*9 - 1,\s*\w+ / 3 % 3 - 1"),
}
RETYPED_ALLOWED = {
    "libvdbsynth/math/lattice.h": "is their home",
}


def retyped(root):
    """Words of math/lattice.h that are spelled out in another file."""
    found = []
    for path in sorted([*root.glob("libvdbsynth/**/*.h"), *root.glob("libvdbsynth/**/*.cpp"),
                        *root.glob("tools/vdb_synth/**/*.h"), *root.glob("tools/vdb_synth/**/*.cpp")]):
        relative = str(path.relative_to(root))
        if relative in RETYPED_ALLOWED:
            continue
        text = path.read_text()
        for what, pattern in RETYPED.items():
            for match in pattern.finditer(text):
                found.append(f"{relative}:{text.count(chr(10), 0, match.start()) + 1}: types out {what}")
    return found



def public_breaches(root):
    """What is installed is small, and complete in itself."""
    text = (root / "libvdbsynth" / "public_headers.cmake").read_text()
    public = set(re.findall(r"^  (\S+\.h)$", text, re.M))
    breaches = []
    if len(public) > MOST_PUBLIC:
        breaches.append(f"libvdbsynth/public_headers.cmake: {len(public)} headers; keep steps and internals inside")
    for header in sorted(public):
        path = root / "libvdbsynth" / header
        if not path.exists():
            breaches.append(f"libvdbsynth/public_headers.cmake: {header} does not exist")
            continue
        for include in re.findall(r'#include "libvdbsynth/([^"]+)"', path.read_text()):
            if include not in public:
                breaches.append(f"libvdbsynth/{header}: is public and includes {include}, which is not")
    return breaches


def main(root):
    breaches = inexact(root) + retyped(root)
    users = {}
    for path in sorted([*root.glob("libvdbsynth/**/*.h"), *root.glob("libvdbsynth/**/*.cpp"),
                        *root.glob("tools/vdb_synth/**/*.h"), *root.glob("tools/vdb_synth/**/*.cpp"),
                        *root.glob("python/vdbsynth/*.h"), *root.glob("python/vdbsynth/*.cpp")]):
        relative = path.relative_to(root)
        room = relative.parts[1] if relative.parts[0] == "libvdbsynth" else relative.parts[0]
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = re.match(r'\s*#include\s*[<"]([^">]+)[">]', line)
            if not match:
                continue
            include = match.group(1)
            where = f"{relative}:{number}"
            inner = re.match(r"libvdbsynth/(\w+)/", include)
            if inner and inner.group(1) not in BELOW[room]:
                breaches.append(f"{where}: {room} may not include {inner.group(1)}")
            if include.startswith("tools/") and room != "tools":
                breaches.append(f"{where}: the tool is included by itself only")
            if include.startswith("python/") and room != "python":
                breaches.append(f"{where}: the Python module is included by itself only")
            for prefix, rooms in ALLOWED.items():
                if include.startswith(prefix):
                    users.setdefault(prefix, set()).add(str(relative))
                    if room not in rooms:
                        breaches.append(f"{where}: {prefix} belongs to {', '.join(sorted(rooms))} only")
            if include.startswith("openvdb/") and room == "pipeline" and path.suffix == ".h":
                breaches.append(f"{where}: headers of pipeline speak of grids through vdb/vdb_fwd.h")
    for prefix in ONE_FILE:
        if len(users.get(prefix, [])) > 1:
            breaches.append(f"{prefix} is included by {', '.join(sorted(users[prefix]))}; one file is enough")
    for folder in sorted({h.parent for h in (root / "libvdbsynth").rglob("*.h")}):
        # What several .cpp files of one function share, and nobody else includes, is no header of the room.
        headers = [h for h in folder.glob("*.h") if not h.name.endswith("_steps.h")]
        if len(headers) > MOST_HEADERS:
            breaches.append(f"{folder.relative_to(root)}: {len(headers)} headers; split the room")
    breaches += nameless(root) + untested(root)
    banned = re.compile(r"random_device|\bs?rand\(|using namespace")
    for path in root.glob("libvdbsynth/**/*.h"):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if banned.search(line):
                breaches.append(f"{path.relative_to(root)}:{number}: {line.strip()}")
    # Messages of the library name fields of option structs in backquotes; flags are the command line's.
    flag = re.compile(r"(?<![\w-])--[a-z]")
    literal = re.compile(r'"(?:[^"\\]|\\.)*"')
    for path in sorted([*root.glob("libvdbsynth/**/*.h"), *root.glob("libvdbsynth/**/*.cpp")]):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if not line.lstrip().startswith("//") and any(flag.search(text) for text in literal.findall(line)):
                breaches.append(f"{path.relative_to(root)}:{number}: names a flag; name the field in backquotes")
    breaches += public_breaches(root)
    print("\n".join(breaches) if breaches else "the stairs hold")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()))
