#!/usr/bin/python3
"""Writes python/vdbsynth/__init__.pyi, the types of the Python module, from the module itself: names, keywords, defaults and
texts are the module's, only what C++ does not say of a Python value is in the tables here.
Usage: PYTHONPATH=build/release/python tools/dev/python_stubs.py [FILE]   prints without FILE"""
import re
import sys

import vdbsynth

HEADER = '''"""Types of vdbsynth. Made by tools/dev/python_stubs.py from the module; do not edit."""
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, Protocol, Union

from numpy.typing import ArrayLike, NDArray

class Event(Protocol):
    """threading.Event, or anything that says whether to stop."""
    def is_set(self) -> bool: ...

Path = Union[str, PathLike[str]]
Index = Sequence[int]
"""Three whole numbers [voxels]."""
Place = Sequence[float]
"""Three numbers."""
Box = Union[tuple[Index, Index], Sequence[int]]
"""((i, j, k), (I, J, K)), or these six: both corners inclusive."""
Size = Union[str, Sequence[Union[int, str]]]
"""Three of whole voxels or multiples such as '2x'; or all in one str, '2x,2x,64'."""
Border = Literal['cut', 'object', 'tile']
Plane = Literal['xy', 'yz', 'zx']
GridLike = Any
"""A Grid, a LevelSet, or a FloatGrid, BoolGrid or Vec3SGrid of pyopenvdb."""
Direction = Union[str, "Grid", Place, Sequence[tuple[Place, Place]]]
"""'axis:z', 'around:y', 'radial' or 'curvature'; a vector; a Grid of vectors or scalars; strokes [(position, direction), ...]."""
Labels = Union[str, "LevelSet", "Grid", NDArray[Any], None]
PyOpenVDBGrid = Any
"""A grid of the module pyopenvdb, which has no types."""

__version__: str
'''

MODELS = "LevelSet | Sequence[LevelSet]"
# Of arguments, by name; some functions have their own.
ARGUMENTS = {
    "path": "Path", "paths": "Path | Sequence[Path]", "outputs": "Path | Sequence[Path]", "voxel_size": "float", "origin": "Place",
    "background": "float", "name": "str", "box": "Box | None", "domain": "Box", "recorded": "bool", "half_width": "float",
    "model": "LevelSet", "models": "LevelSet | GridLike | Sequence[LevelSet | GridLike | Sequence[GridLike]]", "exemplar": "LevelSet", "query": "LevelSet", "made": "LevelSet", "rest": "LevelSet", "posed": "LevelSet",
    "partial": "LevelSet", "target": "LevelSet", "reference": "LevelSet", "exemplars": MODELS, "others": MODELS, "inputs": MODELS,
    "map": "SourceMap", "kind": "str", "source": "PatchSource", "sheet": "PatchSource", "mesh": "Mesh", "metadata": "Mapping[str, str]",
    "comments": "Sequence[str]", "names": "Sequence[str] | None", "maps": "SourceMap | Sequence[SourceMap | None] | None",
    "labels": "Labels", "points": "ArrayLike", "triangles": "ArrayLike | None", "quads": "ArrayLike | None", "normals": "ArrayLike | None",
    "attributes": "Mapping[str, ArrayLike] | None", "types": "Literal['integer', 'float']", "array": "ArrayLike",
    "pairs": "tuple[LevelSet, LevelSet] | Sequence[tuple[LevelSet, LevelSet]]", "grids": "GridLike | Sequence[GridLike]", "function": "str",
    "samples": "TextureSample | Sequence[TextureSample]", "colour": "ArrayLike", "tileable": "bool", "amplitude": "float",
    "heights": "ArrayLike", "height": "float", "pixelSize": "float", "with_model": "LevelSet | None",
    "tile": "Literal['auto', 'yes', 'no']", "files": "Path | Mapping[str, Path] | Sequence[Path | Mapping[str, Path]]",
}
OWN_ARGUMENTS = {
    "LevelSet.from_points": {"points": "PointCloud"}, "crop": {"box": "Box"}, "write_grids": {"grids": "Sequence[GridLike]"},
    "LevelSet.with_attributes": {"grids": "Sequence[GridLike]"}, "Grid.from_openvdb": {"grid": "PyOpenVDBGrid"},
    "fill": {"hole": "LevelSet | Box | Literal['auto']", "exemplar": "LevelSet | None"},
    "mask": {"kind": "Literal['box', 'ball', 'inside', 'range']", "model": "LevelSet | GridLike | None"},
    "render": {"outputs": "Path | Sequence[Path] | None"},
    "filter_analogy": {"pairs": "tuple[GridLike, GridLike] | Sequence[tuple[GridLike, GridLike]]", "target": "GridLike"},
    "texture": {"target": "TextureTarget | LevelSet | Mesh | PointCloud"}, "Texture.displace": {"map": "str"},
    "TextureSample.__init__": {"maps": "Mapping[str, ArrayLike] | None"}, "read_target": {"kind": "Literal['points', 'mesh', 'levelset'] | None"},
    "relief": {"samples": "LevelSet | Heights | Sequence[LevelSet | Heights]"},
    "patch_hole": {"hole": "LevelSet | tuple[Place, Place]", "exemplar": "PatchSource | None"}, "repeat_patch": {"map": "Path", "exemplar": "Path"},
}
# Of what functions and properties give, where the C++ type does not say it.
RETURNS = {
    "grids": "list[dict[str, Any]]", "file_metadata": "dict[str, str]", "read_grids": "list[Grid]", "keywords": "list[tuple[str, str, str, str]]",
    "functions_with_keywords": "list[str]", "minimal_wall": "tuple[float, tuple[float, float, float]] | None",
    "make_pair": "tuple[LevelSet, LevelSet]", "make_points": "tuple[PointCloud, list[str]]", "repeat_patch": "PatchSheet | PatchedModel",
    "Grid.to_openvdb": "PyOpenVDBGrid", "LevelSet.to_openvdb": "PyOpenVDBGrid", "SourceMap.to_grids": "list[Grid]",
    "SourceMap.sources": "dict[str, NDArray[Any]]", "PatchSheet.map_grids": "list[Grid]", "PatchedModel.map_grids": "list[Grid]",
    "Grid.active_box": "tuple[tuple[int, int, int], tuple[int, int, int]] | None", "LevelSet.attributes": "list[Grid]",
    "LevelSet.source": "Mesh | None", "AnalogyResult.directions": "Grid | None", "ReliefExtraction.relief": "Grid | None",
    "ReliefExtraction.reliefVector": "Grid | None", "ReliefExtraction.surface": "LevelSet | None", "ReliefResult.sources": "list[Grid]",
    "TextureSample.maps": "dict[str, tuple[int, int]]",
}
BARE_ARRAY = re.compile(r"NDArray(?!\[)")
BOXES = {"LevelSet.domain", "LevelSet.box", "ModelStatistics.domain"}
PLACES = {"origin", "size"}


def python_type(text, owner, name):
    """The annotation for a type as pybind11 prints it."""
    key = f"{owner}.{name}" if owner else name
    if key in RETURNS:
        return RETURNS[key]
    if key in BOXES:
        return "tuple[tuple[int, int, int], tuple[int, int, int]]"
    text = text.replace("vdbsynth._vdbsynth.", "").replace("vdbsynth.", "")
    text = re.sub(r"List\[", "list[", text)
    text = re.sub(r"\bList\b", "list", text)
    text = re.sub(r"Annotated\[list\[(\w+)\], FixedSize\(\d+\)\]", r"list[\1]", text)
    text = re.sub(r"list\[(\w+)\[\d+\]\]", r"list[\1]", text)
    text = re.sub(r"(\w+)\[\d+\]", r"list[\1]", text) if re.fullmatch(r"\w+\[\d+\]", text) else text
    text = re.sub(r"Optional\[(.*)\]", r"\1 | None", text)
    text = re.sub(r"numpy\.ndarray(\[[^\]]*\])?", "NDArray[Any]", text)
    if text == "tuple":
        return "tuple[float, float, float]" if name in PLACES else "tuple[int, int, int]"
    if text == "dict":
        return "dict[str, NDArray[Any]]"
    if text in ("object", "handle") or "::" in text:
        raise SystemExit(f"{key}: gives {text}; add it to RETURNS")
    return text


def split(arguments):
    """Arguments of a signature, at commas outside brackets and quotes."""
    parts, depth, quote, current = [], 0, "", ""
    for letter in arguments:
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "'\"":
            quote = letter
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0 and not quote:
            parts.append(current.strip())
            current = ""
        else:
            current += letter
    return parts + [current.strip()] if current.strip() else parts


def argument(key, text):
    name = re.match(r"\**(\w+)", text).group(1)
    default = text.split(" = ", 1)[1] if " = " in text else None
    annotation = OWN_ARGUMENTS.get(key, {}).get(name) or ARGUMENTS.get(name)
    if annotation is None:
        raise SystemExit(f"{key}: argument {name} has no type; add it to ARGUMENTS")
    return f"{name}: {annotation}" + (f" = {default}" if default is not None else "")


def doc(text, indent):
    lines = [line.strip() for line in text.strip().splitlines()]
    return "".join(f"{indent}{line}\n" for line in ['"""' + lines[0], *lines[1:]])[:-1] + '"""\n'


def function(key, value, indent, static=False):
    """A def with its positional arguments, its keywords and its text."""
    owner, _, name = key.rpartition(".")
    signature, _, text = value.__doc__.partition("\n")
    match = re.match(r"\w+\((.*)\)(?: -> (.*))?$", signature)
    parts = split(match.group(1))
    takes = any(part.startswith("**") for part in parts)
    arguments = [argument(key, part) for part in parts if not part.startswith("*") and not part.startswith("self:")]
    given = "None" if name == "__init__" or match.group(2) in (None, "None") else python_type(match.group(2), owner, name)
    if owner and not static:
        arguments.insert(0, "self")
    words = vdbsynth.keywords(key) if takes else []
    keywords = [f"{word}: {BARE_ARRAY.sub('NDArray[Any]', annotation)} = {default}" for word, annotation, default, _ in words]
    head = f"{indent}def {name}(" + ", ".join(arguments)
    if keywords:
        head += (", " if arguments else "") + "*,\n" + ",\n".join(f"{indent}        {one}" for one in keywords)
    text = text.split("\nKeywords:")[0]
    body = doc(text, indent + "    ") if text.strip() else ""
    lead = f"{indent}@staticmethod\n" if static else ""
    return f"{lead}{head}) -> {given}:" + (f"\n{body}{indent}    ...\n" if body else " ...\n")


def klass(name, value):
    if issubclass(value, Exception):
        return f"class {name}(Exception):\n{doc(value.__doc__, '    ')}    code: str\n    exit_code: int\n"
    lines = f"class {name}:\n" + (doc(value.__doc__, "    ") if value.__doc__ else "")
    for member, held in sorted(vars(value).items()):
        key = f"{name}.{member}"
        if member == "__init__":
            if "__init__(self: " in held.__doc__:
                lines += function(key, held, "    ")
        elif member.startswith("_"):
            continue
        elif isinstance(held, property):
            signature, _, text = held.fget.__doc__.partition("\n")
            given = python_type(signature.rpartition(" -> ")[2], name, member)
            text = held.__doc__ or ""
            lines += f"    @property\n    def {member}(self) -> {given}:" + ("\n" + doc(text, "        ") + "        ...\n" if text.strip() else " ...\n")
        else:
            lines += function(key, getattr(value, member), "    ", static=isinstance(held, staticmethod))
    return lines if lines.count("\n") > 1 else lines + "    ...\n"


def stubs():
    text = HEADER
    names = sorted(vdbsynth.__all__)
    for name in [n for n in names if isinstance(getattr(vdbsynth, n), type)]:
        text += "\n" + klass(name, getattr(vdbsynth, name))
    for name in [n for n in names if not isinstance(getattr(vdbsynth, n), type)]:
        text += "\n" + function(name, getattr(vdbsynth, name), "")
    return text


if __name__ == "__main__":
    made = stubs()
    compile(made, "__init__.pyi", "exec")
    if len(sys.argv) > 1:
        with open(sys.argv[1], "w") as file:
            file.write(made)
    else:
        print(made, end="")
