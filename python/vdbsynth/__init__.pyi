"""Types of vdbsynth. Made by tools/dev/python_stubs.py from the module; do not edit."""
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

class AnalogyLevelStats:
    """Measurements of one level."""
    @property
    def coherent(self) -> float: ...
    @property
    def components(self) -> int: ...
    @property
    def exactDistance(self) -> float: ...
    @property
    def explained(self) -> float: ...
    @property
    def features(self) -> int: ...
    @property
    def meanDistance(self) -> float: ...
    @property
    def voxels(self) -> int: ...
    @property
    def waves(self) -> int: ...

class AnalogyResult:
    @property
    def cut(self) -> float: ...
    @property
    def directions(self) -> Grid | None:
        """With keepDirections a Grid of unit vectors [world]; else None."""
        ...
    @property
    def levels(self) -> list[AnalogyLevelStats]:
        """A list of AnalogyLevelStats."""
        ...
    @property
    def map(self) -> SourceMap: ...
    @property
    def model(self) -> LevelSet: ...
    @property
    def reach(self) -> float:
        """[voxels] largest distance of the texture from the plain surface."""
        ...
    @property
    def singularities(self) -> NDArray[Any]:
        """float64 [n, 3] world, of the target's directions."""
        ...

class BlockMatch:
    @property
    def cost(self) -> float:
        """[voxels^2] mean squared difference."""
        ...
    @property
    def position(self) -> tuple[int, int, int]:
        """[index] minimum corner in the exemplar."""
        ...

class Comparison:
    """Statistics of a reference and of other models, and their distances [voxels]."""
    @property
    def distances(self) -> list[ModelDistances]:
        """A list of ModelDistances, one of each other model."""
        ...
    @property
    def islandLimit(self) -> int: ...
    @property
    def others(self) -> list[ModelStatistics]:
        """A list of ModelStatistics."""
        ...
    @property
    def parts(self) -> int: ...
    @property
    def reach(self) -> int: ...
    @property
    def reference(self) -> ModelStatistics: ...
    @property
    def stationary(self) -> list[bool]:
        """Truths of the three axes."""
        ...
    @property
    def yardsticks(self) -> list[Yardstick]:
        """A list of Yardstick; empty without a process."""
        ...

class CoordinateLevelStats:
    """What one level of the hierarchy did."""
    @property
    def coherent(self) -> float: ...
    @property
    def cost(self) -> float: ...
    @property
    def sites(self) -> int: ...
    @property
    def step(self) -> float: ...

class Error(Exception):
    """What failed, in one line that names the file, the input or the keyword (in backquotes). `code` is the name of the
    library's ErrorCode (docs/api.md), `exit_code` the command line's exit code for it."""
    code: str
    exit_code: int

class FillResult:
    @property
    def map(self) -> SourceMap: ...
    @property
    def model(self) -> LevelSet: ...
    @property
    def stats(self) -> SynthesisStats: ...

class FilterAnalogyStats:
    @property
    def affineError(self) -> float: ...
    @property
    def change(self) -> float: ...
    @property
    def rows(self) -> int: ...
    @property
    def searchError(self) -> float: ...
    @property
    def searched(self) -> bool: ...

class FilterGridResult:
    @property
    def grid(self) -> Grid: ...
    @property
    def stats(self) -> FilterAnalogyStats: ...

class GradientError:
    @property
    def mean(self) -> float: ...
    @property
    def percentile99(self) -> float: ...

class Grid:
    """An OpenVDB grid of any type. Read only: methods return new ones."""
    def active(self, box: Box | None = None) -> NDArray[Any]:
        """Which voxels of the box are active: truths [x, y, z]."""
        ...
    @property
    def active_box(self) -> tuple[tuple[int, int, int], tuple[int, int, int]] | None:
        """((i, j, k), (I, J, K)) of the active voxels, both corners inclusive; None: there are none."""
        ...
    @property
    def active_voxels(self) -> int: ...
    @staticmethod
    def from_numpy(array: ArrayLike, voxel_size: float = 1.0, origin: Place = (0.0, 0.0, 0.0), background: float = 0.0, name: str = '') -> Grid:
        """A grid of an array [x, y, z], or of vectors [x, y, z, 3]; `origin` [world] is the middle of element
        (0, 0, 0). float32 gives a float grid, float64 double, int32, int64, bool, vectors vec3s. Voxels that
        differ from the background are active."""
        ...
    @staticmethod
    def from_openvdb(grid: PyOpenVDBGrid) -> Grid:
        """A grid of pyopenvdb, which is shared, not copied: do not change it while it is in use here."""
        ...
    @property
    def name(self) -> str: ...
    def to_numpy(self, box: Box | None = None) -> NDArray[Any]:
        """Values in an index box (both corners inclusive; None: that of the active voxels) as an array [x, y, z], or of
        vectors [x, y, z, 3], in the grid's own type: tiles and background included."""
        ...
    def to_openvdb(self) -> PyOpenVDBGrid:
        """The same grid as an object of pyopenvdb, shared: deepCopy() it before you change it. TypeError for types that
        pyopenvdb has no class for (Debian's has FloatGrid, BoolGrid and Vec3SGrid)."""
        ...
    @property
    def transform(self) -> NDArray[Any]:
        """float64 [4, 4] from index space to the world: world = transform @ (i, j, k, 1)."""
        ...
    @property
    def type(self) -> str:
        """Of its values, as OpenVDB names it: float, vec3s, int32, ..."""
        ...

class Heights:
    """A picture of heights, as a sample of relief."""
    def __init__(self, heights: ArrayLike, height: float = 0.0, pixelSize: float = 0.0, tileable: bool = False) -> None:
        """heights: [rows, columns], the top row first, from 0 to 1, or whole numbers of 8 or 16 bits; height [world] of 1 over 0,
        0: 5 voxels of the target times the scale; pixelSize [world] of a pixel on the target at scale 1, 0: a voxel."""
        ...
    @property
    def height(self) -> float: ...
    @property
    def heights(self) -> NDArray[Any]: ...
    @property
    def pixelSize(self) -> float: ...

class LevelSet:
    """A model: a narrow-band level set, negative inside, with a domain. Read only: methods return new ones."""
    @property
    def active_voxels(self) -> int: ...
    @property
    def attributes(self) -> list[Grid]:
        """Other grids of the model, a list of Grid: colour, density, ..."""
        ...
    @property
    def box(self) -> tuple[tuple[int, int, int], tuple[int, int, int]]:
        """((i, j, k), (I, J, K)): the index box of the band and the domain, which to_numpy gives."""
        ...
    @property
    def domain(self) -> tuple[tuple[int, int, int], tuple[int, int, int]]:
        """((i, j, k), (I, J, K)): the index box that sizes and statistics refer to, both corners inclusive."""
        ...
    @property
    def domainRecorded(self) -> bool:
        """False: the domain is the box of the solid."""
        ...
    @staticmethod
    def from_mesh(mesh: Mesh, voxel_size: float, *,
            halfWidth: float = 3.0,
            carry: bool = True,
            keepSource: bool = False,
            open: Literal['close', 'shell'] = 'close',
            thickness: float = 0.0,
            exact: bool = False,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> LevelSet:
        """A level set of a mesh, as read_model makes of a file."""
        ...
    @staticmethod
    def from_numpy(array: ArrayLike, voxel_size: float = 1.0, origin: Place = (0.0, 0.0, 0.0), *,
            halfWidth: float = 3.0,
            domainRecorded: bool = False,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> LevelSet:
        """A level set of signed distances [x, y, z] in world units, negative inside. `origin` [world] is the
        middle of element (0, 0, 0). Distances beyond the half-width are clamped, so an array that covers the
        band and the inside is enough. A solid that the array cuts is closed there and taken as a piece; a message says so."""
        ...
    @staticmethod
    def from_openvdb(grids: GridLike | Sequence[GridLike], *,
            gridName: str = '',
            iso: float | None = None,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> LevelSet:
        """A model of one grid, or of a list of which one is taken: Grid or grids of pyopenvdb, which are shared.
        Level sets keep their tree; others are converted, as read_model does."""
        ...
    @staticmethod
    def from_points(points: PointCloud, voxel_size: float, *,
            halfWidth: float = 3.0,
            carry: bool = True,
            keepSource: bool = False,
            open: Literal['close', 'shell'] = 'close',
            thickness: float = 0.0,
            exact: bool = False,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> LevelSet:
        """A level set of points, as read_model makes of a file."""
        ...
    @staticmethod
    def from_volume(array: ArrayLike, voxel_size: float = 1.0, origin: Place = (0.0, 0.0, 0.0), *,
            threshold: float | None = None,
            below: float | None = None,
            labels: Sequence[float | tuple[float, float]] = (),
            halfWidth: float = 3.0,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> LevelSet:
        """The solid of a volume of any values [x, y, z]: where the value is above `threshold`, below `below`, one of
        `labels`, or the larger of only two values. The array's box is the recorded domain. NaN is outside."""
        ...
    @property
    def grid(self) -> Grid:
        """The level set as a Grid, shared."""
        ...
    @property
    def half_width(self) -> float:
        """[voxels] of the band."""
        ...
    @property
    def hash(self) -> str:
        """Of values, active states and transform."""
        ...
    @property
    def origin(self) -> tuple[float, float, float]:
        """(x, y, z) world: the middle of the first voxel of `box`."""
        ...
    @property
    def source(self) -> Mesh | None:
        """The Mesh it was made from, where that was kept; else None."""
        ...
    def to_mesh(self, *,
            adaptivity: float = 0.0,
            sharp: bool = False,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> Mesh:
        """The surface as a closed Mesh, with the model's attributes at its vertices."""
        ...
    def to_numpy(self, box: Box | None = None) -> NDArray[Any]:
        """Signed distances [world] as float32 [x, y, z], negative inside, in an index box (both corners inclusive; None:
        `box`). Beyond the band they are plus or minus the half-width."""
        ...
    def to_openvdb(self) -> PyOpenVDBGrid:
        """The level set as a FloatGrid of pyopenvdb, shared: deepCopy() it before you change it."""
        ...
    def to_points(self, *,
            spacing: float = 1.0,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> PointCloud:
        """Evenly spaced points on the surface, with normals and the model's attributes."""
        ...
    @property
    def transform(self) -> NDArray[Any]:
        """float64 [4, 4] from index space to the world: world = transform @ (i, j, k, 1)."""
        ...
    @property
    def voxel_size(self) -> float:
        """[world] side of a voxel."""
        ...
    def with_attributes(self, grids: Sequence[GridLike]) -> LevelSet:
        """The same surface with these attributes, a list of Grid."""
        ...
    def with_domain(self, domain: Box, recorded: bool = True) -> LevelSet:
        """The same surface with another domain [index], both corners inclusive; recorded: a texture that continues beyond it."""
        ...
    def with_half_width(self, half_width: float, *,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> LevelSet:
        """The same surface with a band of this half-width [voxels], 1.5 to 100."""
        ...
    def write(self, paths: Path | Sequence[Path], *,
            points: bool = False,
            sharp: bool = False,
            adaptivity: float = 0.0,
            spacing: float = 1.0,
            plane: Plane = 'xy',
            height: float = 0.0,
            unit: str = '',
            values: Literal['inside', 'distance', 'density'] = 'inside',
            extraGrids: Sequence[GridLike] = (),
            name: str = '',
            half: bool = False,
            metadata: Mapping[str, str] = {},
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> None:
        """Writes one path or several, kinds by extension: .vdb, .obj, .ply, .stl, .off, .glb, .gltf, .3mf, and heights as
        .png and .exr. Outputs appear whole and together, or not at all."""
        ...

class LocalPatches:
    @property
    def meanIoU(self) -> float: ...
    @property
    def shareIoU(self) -> float: ...
    @property
    def shareScore(self) -> float: ...

class MatchResult:
    @property
    def exactnessRatio(self) -> float: ...
    @property
    def known(self) -> int:
        """Samples of the query that were compared."""
        ...
    @property
    def matches(self) -> list[BlockMatch]:
        """A list of BlockMatch, best first."""
        ...
    @property
    def recall(self) -> float: ...

class Mesh:
    """A mesh of triangles and quads, counter-clockwise seen from outside. Read only."""
    def __init__(self, points: ArrayLike, triangles: ArrayLike | None = None, quads: ArrayLike | None = None, attributes: Mapping[str, ArrayLike] | None = None, origin: Place = (0.0, 0.0, 0.0)) -> None:
        """points: [vertices, 3] world, relative to `origin`; triangles [n, 3] and quads [n, 4] are numbers of vertices;
        attributes: a dict of arrays [vertices] or [vertices, 1 to 3]; colours are 'Cd' (0 to 1), texture coordinates 'uv'."""
        ...
    @property
    def attributes(self) -> dict[str, NDArray[Any]]:
        """A dict of float32 arrays [vertices] or [vertices, width]."""
        ...
    @property
    def origin(self) -> tuple[float, float, float]:
        """(x, y, z) world: zero, but where coordinates are too large for floats."""
        ...
    @property
    def points(self) -> NDArray[Any]:
        """float32 [vertices, 3], world, relative to `origin`."""
        ...
    @property
    def quads(self) -> NDArray[Any]:
        """uint32 [quads, 4]."""
        ...
    @property
    def triangles(self) -> NDArray[Any]:
        """uint32 [triangles, 3]."""
        ...
    def write(self, path: Path, *,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> None:
        """Writes .obj, .ply, .stl, .off, .glb, .gltf or .3mf, which appears whole or not at all."""
        ...

class ModelDistances:
    """The measurements of a model relative to the reference."""
    @property
    def localPatches(self) -> LocalPatches: ...
    @property
    def novelty(self) -> Novelty: ...
    @property
    def scales(self) -> list[PatchDistances]:
        """A list of PatchDistances."""
        ...
    @property
    def surface(self) -> SurfaceDistance | None:
        """SurfaceDistance, if both overlap in the world; else None."""
        ...
    @property
    def verdicts(self) -> list[Verdict]:
        """A list of Verdict."""
        ...
    @property
    def verified(self) -> float: ...

class ModelStatistics:
    """The measurements of one model."""
    @property
    def bandCompleteness(self) -> float: ...
    @property
    def domain(self) -> tuple[tuple[int, int, int], tuple[int, int, int]]: ...
    @property
    def domainRecorded(self) -> bool: ...
    @property
    def gradient(self) -> GradientError: ...
    @property
    def islands(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def relief(self) -> ReliefStatistics | None:
        """ReliefStatistics; None: not asked for."""
        ...
    @property
    def statistics(self) -> list[Statistic]:
        """A list of Statistic."""
        ...
    @property
    def topology(self) -> Topology: ...
    @property
    def voxelSize(self) -> float: ...

class Novelty:
    @property
    def exemplarUsed(self) -> float: ...
    @property
    def largestRun(self) -> float: ...
    @property
    def largestShare(self) -> float: ...
    @property
    def meanRun(self) -> float: ...
    @property
    def seamRatio(self) -> float: ...
    @property
    def seamShare(self) -> float: ...
    @property
    def verbatimShare(self) -> float: ...
    @property
    def voxels(self) -> int: ...

class PatchDistances:
    """Distances between patches of one size [voxels]."""
    @property
    def coherence(self) -> float: ...
    @property
    def completeness(self) -> float: ...
    @property
    def wasserstein(self) -> float: ...

class PatchSheet:
    """A sheet of a geometry texture."""
    @property
    def depth(self) -> float:
        """[world]"""
        ...
    def level_set(self, voxel_size: float = 0.0, *,
            halfWidth: float = 3.0,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> LevelSet:
        """The solid below, or within, its points; voxel_size [world], 0: the exemplar's."""
        ...
    def map_grids(self) -> list[Grid]:
        """Its source map, for write_grids and repeat_patch: a list of Grid."""
        ...
    @property
    def patch(self) -> float:
        """[world] side of a patch."""
        ...
    @property
    def patches(self) -> int:
        """Number of patches."""
        ...
    def points(self) -> PointCloud:
        """Its points as a PointCloud: normals, the exemplar's attributes, `patch` and `source`."""
        ...
    @property
    def width(self) -> float:
        """[world]"""
        ...

class PatchSource:
    """A geometry texture: oriented points that continue beyond a box."""
    @property
    def count(self) -> int:
        """Number of points."""
        ...
    @property
    def recorded(self) -> bool:
        """The file says its box."""
        ...
    @property
    def size(self) -> tuple[float, float, float]:
        """[world] of the box: along the plane's two axes, and the height."""
        ...
    @property
    def spacing(self) -> float:
        """[world] of the points."""
        ...
    @property
    def voxelSize(self) -> float:
        """[world] of level sets made of it."""
        ...

class PatchedModel:
    """A geometry texture over a model, which is no part of it."""
    def level_set(self, voxel_size: float = 0.0, with_model: LevelSet | None = None, *,
            halfWidth: float = 3.0,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> LevelSet:
        """The solid that its points bound, united with with_model (LevelSet) if given; voxel_size [world], 0: the exemplar's."""
        ...
    def map_grids(self) -> list[Grid]:
        """Its source map, for write_grids and repeat_patch: a list of Grid."""
        ...
    @property
    def patch(self) -> float:
        """[world] diameter of a patch."""
        ...
    @property
    def patches(self) -> int:
        """Number of patches."""
        ...
    def points(self) -> PointCloud:
        """Its points as a PointCloud: normals, the exemplar's attributes, `patch` and `source`."""
        ...

class PointCloud:
    """Points with normals that face out of the solid. Read only."""
    def __init__(self, points: ArrayLike, normals: ArrayLike | None = None, attributes: Mapping[str, ArrayLike] | None = None, origin: Place = (0.0, 0.0, 0.0)) -> None:
        """points and normals: [points, 3] world, points relative to `origin`; attributes as of Mesh."""
        ...
    @property
    def attributes(self) -> dict[str, NDArray[Any]]:
        """A dict of float32 arrays [points] or [points, width]."""
        ...
    @property
    def normals(self) -> NDArray[Any]:
        """float32 [points, 3], or [0, 3]: unknown."""
        ...
    @property
    def origin(self) -> tuple[float, float, float]:
        """(x, y, z) world."""
        ...
    @property
    def points(self) -> NDArray[Any]:
        """float32 [points, 3], world, relative to `origin`."""
        ...
    def write(self, path: Path, comments: Sequence[str] = [], *,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> None:
        """Writes .ply, which appears whole or not at all; comments are lines of its header."""
        ...

class ReliefExtraction:
    """A scan split into a smooth base and its relief."""
    @property
    def base(self) -> LevelSet:
        """LevelSet."""
        ...
    @property
    def baseCounts(self) -> SurfaceCounts: ...
    @property
    def radius(self) -> float:
        """[world] of the base."""
        ...
    @property
    def relief(self) -> Grid | None:
        """Grid of heights along the base's normal [world]."""
        ...
    @property
    def reliefVector(self) -> Grid | None:
        """Grid of vectors to the scan's surface [world], where the relief folds; None: nowhere."""
        ...
    @property
    def scanCounts(self) -> SurfaceCounts: ...
    @property
    def statistics(self) -> ReliefStatistics: ...
    @property
    def surface(self) -> LevelSet | None:
        """base + strength * relief, a LevelSet; None: no strength was given."""
        ...
    def write(self, paths: Path | Sequence[Path], metadata: Mapping[str, str] = {}, *,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> None:
        """Writes one path or several: .vdb (base, relief, relief_vector, surface), .ply (the base with its relief), .png and .exr
        (of a flat scan), and with a strength meshes of the surface."""
        ...

class ReliefOctave:
    """The part of a relief between two wavelengths."""
    @property
    def deviation(self) -> float: ...
    @property
    def longest(self) -> float: ...
    @property
    def shortest(self) -> float: ...

class ReliefResult:
    def bake(self, mesh: Mesh, path: Path, *,
            size: int = 1024,
            bits: int = 16,
            reach: float = 0.0,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> None:
        """Bakes the relief onto the texture coordinates (attribute uv) of the target's Mesh: displacement, or by the end of the
        path's name _vector (.exr) or _normal."""
        ...
    @property
    def baseRadius(self) -> float:
        """[world]"""
        ...
    @property
    def covered(self) -> list[float]: ...
    @property
    def fitted(self) -> float: ...
    @property
    def folds(self) -> bool: ...
    @property
    def levels(self) -> list[CoordinateLevelStats]:
        """A list of CoordinateLevelStats."""
        ...
    @property
    def mismatch(self) -> float: ...
    @property
    def model(self) -> LevelSet: ...
    @property
    def parts(self) -> int: ...
    @property
    def reach(self) -> float:
        """[world]"""
        ...
    @property
    def singularities(self) -> NDArray[Any]:
        """float64 [n, 3] world."""
        ...
    @property
    def sources(self) -> list[Grid]:
        """A list of Grid over the result's band: source_u, source_v, exemplar, source."""
        ...
    @property
    def texel(self) -> float:
        """[world]"""
        ...
    @property
    def unchanged(self) -> float: ...

class ReliefStatistics:
    """Roughness as ISO 25178 counts it [voxels]."""
    @property
    def area(self) -> float: ...
    @property
    def folded(self) -> float: ...
    @property
    def highest(self) -> float: ...
    @property
    def lost(self) -> float: ...
    @property
    def lowest(self) -> float: ...
    @property
    def mean(self) -> float: ...
    @property
    def octaves(self) -> list[ReliefOctave]:
        """A list of ReliefOctave."""
        ...
    @property
    def sa(self) -> float: ...
    @property
    def sku(self) -> float: ...
    @property
    def sq(self) -> float: ...
    @property
    def ssk(self) -> float: ...

class RepairedSheet:
    """A sheet whose hole was filled."""
    @property
    def kept(self) -> int:
        """Points that were not touched."""
        ...
    def level_set(self, voxel_size: float = 0.0, *,
            halfWidth: float = 3.0,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> LevelSet:
        """The solid below, or within, its points; voxel_size [world], 0: the sheet's."""
        ...
    @property
    def patches(self) -> int:
        """Patches laid into the hole."""
        ...
    def points(self) -> PointCloud:
        """All points: those that stay first, in their order."""
        ...
    @property
    def removed(self) -> int:
        """Points that lay in the hole."""
        ...

class SourceMap:
    """Which voxel of which model every voxel of a result was copied from."""
    @property
    def inputs(self) -> int:
        """Number of models that repeat takes."""
        ...
    @property
    def method(self) -> str:
        """'synthesis', 'fill' or 'analogy'."""
        ...
    def sources(self, model: LevelSet, *,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> dict[str, NDArray[Any]]:
        """Arrays over the result's mapped voxels: voxel int32 [n, 3] (index of the result), exemplar int32 [n], position
        float64 [n, 3] (index of the exemplar, between voxels), rotation float32 [n, 3] (vector, radians), scale float32 [n]."""
        ...
    def to_grids(self, model: LevelSet, types: Literal['integer', 'float'] = 'integer', *,
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> list[Grid]:
        """The map as a list of Grid over the result's voxels, as --source-map writes it: extraGrids of
        LevelSet.write, or write_grids. types 'float': Vec3S and float only, which pyopenvdb reads."""
        ...

class Statistic:
    """A number, or a curve, of a model; docs/measures.md defines each."""
    @property
    def curve(self) -> bool: ...
    @property
    def name(self) -> str: ...
    @property
    def power(self) -> int:
        """World value = value * voxel size ** power."""
        ...
    @property
    def values(self) -> NDArray[Any]:
        """float64 [1], [3] by axis, or the curve; empty: not measured."""
        ...

class SurfaceCounts:
    """Connected components and tunnels of a solid."""
    @property
    def solids(self) -> int: ...
    @property
    def tunnels(self) -> int: ...
    @property
    def voids(self) -> int: ...

class SurfaceDistance:
    """[voxels of the reference]"""
    @property
    def hausdorff(self) -> float: ...
    @property
    def mean(self) -> float: ...
    @property
    def rootMean(self) -> float: ...

class SynthResult:
    @property
    def map(self) -> SourceMap: ...
    @property
    def model(self) -> LevelSet: ...
    @property
    def stats(self) -> SynthesisStats: ...

class SynthesisStats:
    """What a synthesis did."""
    @property
    def block(self) -> int:
        """[voxels] side of the blocks."""
        ...
    @property
    def exact(self) -> int:
        """Costs computed."""
        ...
    @property
    def indexBytes(self) -> int: ...
    @property
    def levels(self) -> int:
        """Passes."""
        ...
    @property
    def matches(self) -> int: ...
    @property
    def meanCost(self) -> float:
        """[voxels^2] of the last pass's matches."""
        ...
    @property
    def nodes(self) -> int:
        """Bounds computed."""
        ...

class Texture:
    """A textured target: coordinates in its samples, and the values there."""
    @property
    def attributes(self) -> dict[str, NDArray[Any]]:
        """A dict of arrays [elements, ...]: Cd, other maps, source_u, source_v, source_exemplar, source_tangent."""
        ...
    @property
    def coordinate(self) -> NDArray[Any]:
        """float32 [sites, 2]: u, v in texels of the sample, from its lower left corner, right and up."""
        ...
    def displace(self, map: str, amplitude: float) -> Texture:
        """Moved along its normals by amplitude [world] times a map's value: a new Texture."""
        ...
    @property
    def levels(self) -> list[CoordinateLevelStats]:
        """A list of CoordinateLevelStats."""
        ...
    @property
    def points(self) -> NDArray[Any]:
        """float32 [elements, 3], world, relative to target.origin, displaced."""
        ...
    @property
    def sample(self) -> NDArray[Any]:
        """int32 [sites]: number of the sample; -1: none."""
        ...
    @property
    def tangent(self) -> NDArray[Any]:
        """float32 [sites, 3]: the direction of +u, of length 1."""
        ...
    @property
    def target(self) -> TextureTarget:
        """The TextureTarget."""
        ...
    @property
    def texel(self) -> float:
        """[world] side of a texel on the surface."""
        ...
    @property
    def values(self) -> NDArray[Any]:
        """float32 [sites, channels] of all maps, as TextureSample.image."""
        ...
    def write(self, paths: Path | Sequence[Path], *,
            bake: bool = False,
            bakeSize: int = 1024,
            bakeBits: int = 8,
            voxelSize: float = 0.0,
            resolution: int = 0,
            halfWidth: float = 3.0,
            metadata: Mapping[str, str] = {},
            seed: int = 0,
            threads: int = 0,
            maxMemory: int = 0,
            onProgress: Callable[[str, int, int], object] | None = None,
            onMessage: Callable[[str, str], object] | None = None,
            cancel: Event | None = None) -> None:
        """Writes one path or several: .ply, .obj, .off, .glb, .gltf, .3mf, .vdb, and with bake=True pictures .png and .exr."""
        ...

class TextureSample:
    """A picture to imitate, with further maps."""
    def __init__(self, colour: ArrayLike, maps: Mapping[str, ArrayLike] | None = None, tileable: bool = False, name: str = 'sample') -> None:
        """colour: [rows, columns] or [rows, columns, 3], the top row first: floats 0 to 1, or whole numbers of 8 or 16 bits.
        maps: a dict of arrays of the same size with one or three channels. tileable: it continues at its opposite border."""
        ...
    @property
    def image(self) -> NDArray[Any]:
        """float32 [rows, columns, channels], the top row first: all maps."""
        ...
    @property
    def maps(self) -> dict[str, tuple[int, int]]:
        """A dict: which channels of `image` a map is, (first, count); the colour is 'Cd'."""
        ...
    @property
    def tileable(self) -> bool: ...

class TextureTarget:
    """A target of texturing: its elements (points or vertices) and sites (places; elements at one place are one site)."""
    @property
    def attributes(self) -> dict[str, NDArray[Any]]: ...
    @property
    def kind(self) -> str:
        """'points', 'mesh' or 'levelset'."""
        ...
    @property
    def normal(self) -> NDArray[Any]:
        """float32 [sites, 3] of length 1, outward."""
        ...
    @property
    def origin(self) -> tuple[float, float, float]: ...
    @property
    def points(self) -> NDArray[Any]:
        """float32 [elements, 3], world, relative to `origin`."""
        ...
    @property
    def site(self) -> NDArray[Any]:
        """float32 [sites, 3], world, relative to `origin`."""
        ...
    @property
    def siteOf(self) -> NDArray[Any]:
        """uint32 [elements]."""
        ...
    @property
    def triangles(self) -> NDArray[Any]:
        """uint32 [triangles, 3]; of points none."""
        ...

class Topology:
    """Counts of a whole model."""
    @property
    def enclosed(self) -> float: ...
    @property
    def eulerCharacteristic(self) -> float: ...
    @property
    def solids(self) -> int:
        """Components of the solid."""
        ...
    @property
    def tunnels(self) -> float: ...
    @property
    def voids(self) -> int:
        """Components of the void."""
        ...

class Verdict:
    """One statistic of a result relative to the spread of the reference's own sub-volumes."""
    @property
    def distance(self) -> float: ...
    @property
    def mean(self) -> float: ...
    @property
    def name(self) -> str: ...
    @property
    def passes(self) -> bool: ...
    @property
    def quartile(self) -> float: ...
    @property
    def sigma(self) -> float: ...

class Yardstick:
    """Distances of results from an exemplar, relative to its process."""
    @property
    def fresh(self) -> float: ...
    @property
    def name(self) -> str: ...
    @property
    def ratio(self) -> float:
        """1: as far as another sample of the process."""
        ...
    @property
    def results(self) -> float: ...
    @property
    def shifted(self) -> float: ...

def analogy(pairs: tuple[LevelSet, LevelSet] | Sequence[tuple[LevelSet, LevelSet]], target: LevelSet, *,
        levels: int = 0,
        sweeps: int = 2,
        half: int = 2,
        coarseHalf: int = 1,
        components: int = 16,
        coherence: float = 1.0,
        epsilon: float = 4.0,
        causal: bool = False,
        curvatureAdapted: bool = True,
        aligned: bool = True,
        direction: Direction = 'curvature',
        exemplarDirection: Direction = 'curvature',
        scale: float = 1.0,
        strength: float = 1.0,
        mask: GridLike | None = None,
        thin: Literal['scale', 'keep', 'as-is'] = 'scale',
        draft: bool = False,
        halfWidth: float = 3.0,
        keepDirections: bool = False,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> AnalogyResult:
    """plain : textured = target : result. `pairs`: (plain, textured), or a list of such pairs. AnalogyResult(model, map, ...)."""
    ...

def compare(reference: LevelSet, others: LevelSet | Sequence[LevelSet], names: Sequence[str] | None = None, maps: SourceMap | Sequence[SourceMap | None] | None = None, *,
        stationary: str | Sequence[bool] | None = None,
        process: Mapping[str, object] | None = None,
        fresh: int = 10,
        full: bool = False,
        reliefRadius: float | None = None,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> Comparison:
    """Measures models and how far they are from a reference: a Comparison. others: one LevelSet or a list, of the reference's
    voxel size; maps: their SourceMaps, whose exemplar 0 is the reference, or None: those among their attributes."""
    ...

def convert(path: Path, outputs: Path | Sequence[Path], *,
        voxelSize: float = 0.0,
        resolution: int = 0,
        halfWidth: float = 3.0,
        open: Literal['close', 'shell'] = 'close',
        thickness: float = 0.0,
        exact: bool = False,
        grid: str = '',
        iso: float | None = None,
        pixelSize: float = 0.0,
        pixelSides: Place = (0.0, 0.0, 0.0),
        height: float = 0.0,
        base: float = 0.0,
        plane: Plane = 'xy',
        threshold: float | None = None,
        below: float | None = None,
        labels: Sequence[float | tuple[float, float]] = (),
        carry: bool = True,
        keepSource: bool = False,
        unitScale: float = 1.0,
        imageAsVolume: bool = False,
        points: bool = False,
        sharp: bool = False,
        adaptivity: float = 0.0,
        spacing: float = 1.0,
        unit: str = '',
        values: Literal['inside', 'distance', 'density'] = 'inside',
        extraGrids: Sequence[GridLike] = (),
        name: str = '',
        half: bool = False,
        metadata: Mapping[str, str] = {},
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> LevelSet:
    """vdb_synth convert: reads a model with its attributes (carry is True here), writes it to one path or several,
    returns it."""
    ...

def crop(model: LevelSet, box: Box, *,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> LevelSet:
    """The part of a model inside an index box ((i, j, k), (I, J, K)), both corners inclusive, which becomes its
    recorded domain."""
    ...

def exemplar_kinds() -> list[str]:
    """Kinds that make and make_points take."""
    ...

def file_metadata(path: Path, *,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> dict[str, str]:
    """The metadata of a VDB file: a dict of str."""
    ...

def fill(partial: LevelSet, hole: LevelSet | Box | Literal['auto'], exemplar: LevelSet | None = None, *,
        block: int = 0,
        levels: int = 0,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> FillResult:
    """vdb_synth synth --keep: a model with its holes filled from its surroundings or from an exemplar. `hole`: a LevelSet
    whose inside is filled, an index box ((i, j, k), (I, J, K)), or 'auto' (of a model with keepSource: around its mesh's
    open edges). FillResult(model, map, stats)."""
    ...

def filter_analogy(pairs: tuple[GridLike, GridLike] | Sequence[tuple[GridLike, GridLike]], target: GridLike, *,
        half: int = 2,
        levels: int = 3,
        components: int = 16,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> FilterGridResult:
    """Applies to a scalar grid, such as a density, the filter that other grids show: `pairs` (before, after), or a list of
    such pairs, of Grid. FilterGridResult(grid, stats)."""
    ...

def functions_with_keywords() -> list[str]:
    """All names that keywords() takes."""
    ...

def grids(path: Path, *,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> list[dict[str, Any]]:
    """The grids of a VDB file, one dict each: name, type, gridClass, voxelSize [world], activeVoxels, activeBox, metadata, and of floats background, minimum, maximum, finite. Grids of types that pyopenvdb does not know are listed too."""
    ...

def keywords(function: str) -> list[tuple[str, str, str, str]]:
    """Keywords of a function or method, such as "synth" or "LevelSet.write": a list of (name, type, default, text)."""
    ...

def make(kind: str, *,
        size: Index = (0, 0, 0),
        resolution: int = 64,
        feature: float = 0.0,
        voxelSize: float = 1.0,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> LevelSet:
    """A procedural exemplar, one of exemplar_kinds(), as a LevelSet with a recorded domain."""
    ...

def make_pair(kind: str, *,
        size: Index = (0, 0, 0),
        resolution: int = 64,
        feature: float = 0.0,
        voxelSize: float = 1.0,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> tuple[LevelSet, LevelSet]:
    """A procedural pair for analogies, one of pair_kinds(): (plain, textured)."""
    ...

def make_points(kind: str, *,
        size: Index = (0, 0, 0),
        resolution: int = 64,
        feature: float = 0.0,
        voxelSize: float = 1.0,
        spacing: float = 0.0,
        margin: float = -1.0,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> tuple[PointCloud, list[str]]:
    """A geometry texture as points, which continue beyond its domain: (PointCloud, comments). Written with these comments
    the .ply says its box, for read_patch_source."""
    ...

def mask(kind: Literal['box', 'ball', 'inside', 'range'], model: LevelSet | GridLike | None = None, *,
        box: Box | None = None,
        center: Place | None = None,
        radius: float | None = None,
        range: float | tuple[float, float] | None = None,
        voxelSize: float | None = None,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> Grid:
    """A mask as a bool Grid named "mask", active and True where it holds. `kind` is 'box' (needs `box`), 'ball' (`center`
    and `radius`), 'inside' (a LevelSet `model`) or 'range' (`range`, and a LevelSet or a grid of floats, whose active
    voxels count). A mask of a model has its voxels."""
    ...

def match(exemplar: LevelSet, query: LevelSet, *,
        block: int = 16,
        at: Index = (0, 0, 0),
        count: int = 1,
        tolerance: float = 0.0,
        check: bool = False,
        indexCache: str = '',
        mask: GridLike | None = None,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> MatchResult:
    """The blocks of an exemplar with the smallest differences to one of the query's: MatchResult(matches, known, ...)."""
    ...

def minimal_wall(model: LevelSet, *,
        share: float = 0.001,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> tuple[float, tuple[float, float, float]] | None:
    """How thin a solid gets: (thickness, (x, y, z)) in world units, or None where nothing was found."""
    ...

def pair_kinds() -> list[str]:
    """Kinds that make_pair takes."""
    ...

def patch(source: PatchSource, *,
        method: Literal['default', 'paper'] = 'default',
        width: float = 0.0,
        depth: float = 0.0,
        border: float = 0.0,
        patch: float = 0.0,
        overlap: float = 0.0,
        tolerance: float = 0.1,
        step: float = 0.0,
        tile: bool = False,
        repairs: int = 2,
        warp: bool = True,
        blend: bool = True,
        seedPlace: Place | None = None,
        weights: Mapping[str, object] | None = None,
        limits: Mapping[str, object] = {},
        rounds: int = 3,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> PatchSheet:
    """A larger sheet of a geometry texture: a PatchSheet. width and depth are needed."""
    ...

def patch_hole(sheet: PatchSource, hole: LevelSet | tuple[Place, Place], exemplar: PatchSource | None = None, *,
        method: Literal['default', 'paper'] = 'default',
        width: float = 0.0,
        depth: float = 0.0,
        border: float = 0.0,
        patch: float = 0.0,
        overlap: float = 0.0,
        tolerance: float = 0.1,
        step: float = 0.0,
        tile: bool = False,
        repairs: int = 2,
        warp: bool = True,
        blend: bool = True,
        seedPlace: Place | None = None,
        weights: Mapping[str, object] | None = None,
        limits: Mapping[str, object] = {},
        rounds: int = 3,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> RepairedSheet:
    """Fills a hole of a sheet (read_patch_source with whole=True) with patches of the rest of it, or of an exemplar. hole: a
    LevelSet, or two corners ((x, y, z), (X, Y, Z)) [world]. A RepairedSheet."""
    ...

def patch_onto(source: PatchSource, model: LevelSet, *,
        patch: float = 0.0,
        overlap: float = 0.0,
        tolerance: float = 0.1,
        step: float = 0.0,
        repairs: int = 2,
        warp: bool = True,
        blend: bool = True,
        scale: float = 1.0,
        heightOffset: float = 0.0,
        direction: Direction | None = None,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> PatchedModel:
    """Lays a geometry texture over a model: a PatchedModel."""
    ...

def pose(made: LevelSet, rest: LevelSet, posed: LevelSet, *,
        halfWidth: float = 3.0,
        reach: float = 8.0,
        restGrid: str = 'rest',
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> LevelSet:
    """What was made of a surface at rest, carried to another pose of that surface. Meshes need keepSource, and the same faces."""
    ...

def read_grids(path: Path, *,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> list[Grid]:
    """All grids of a VDB file, a list of Grid."""
    ...

def read_map(path: Path, *,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> SourceMap:
    """The source map in a .vdb file."""
    ...

def read_mesh(path: Path, *,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> Mesh:
    """A mesh file as it is: .obj, .ply, .stl, .off, .glb, .gltf, .3mf, .mesh, each also with .gz."""
    ...

def read_model(path: Path, *,
        voxelSize: float = 0.0,
        resolution: int = 0,
        halfWidth: float = 3.0,
        open: Literal['close', 'shell'] = 'close',
        thickness: float = 0.0,
        exact: bool = False,
        grid: str = '',
        iso: float | None = None,
        pixelSize: float = 0.0,
        pixelSides: Place = (0.0, 0.0, 0.0),
        height: float = 0.0,
        base: float = 0.0,
        plane: Plane = 'xy',
        threshold: float | None = None,
        below: float | None = None,
        labels: Sequence[float | tuple[float, float]] = (),
        carry: bool = False,
        keepSource: bool = False,
        unitScale: float = 1.0,
        imageAsVolume: bool = False,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> LevelSet:
    """A file of any supported geometry as a level set: VDB, meshes, points, images, volumes (docs/formats.md)."""
    ...

def read_onto_model(path: Path, source: PatchSource, *,
        patch: float = 0.0,
        overlap: float = 0.0,
        tolerance: float = 0.1,
        step: float = 0.0,
        repairs: int = 2,
        warp: bool = True,
        blend: bool = True,
        scale: float = 1.0,
        heightOffset: float = 0.0,
        direction: Direction | None = None,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> LevelSet:
    """A model to lay an exemplar over, as a LevelSet of voxels half a field step wide."""
    ...

def read_patch_source(path: Path, *,
        plane: Plane | None = None,
        voxelSize: float = 0.0,
        resolution: int = 0,
        halfWidth: float = 3.0,
        open: Literal['close', 'shell'] = 'close',
        thickness: float = 0.0,
        exact: bool = False,
        grid: str = '',
        iso: float | None = None,
        pixelSize: float = 0.0,
        pixelSides: Place = (0.0, 0.0, 0.0),
        height: float = 0.0,
        base: float = 0.0,
        threshold: float | None = None,
        below: float | None = None,
        labels: Sequence[float | tuple[float, float]] = (),
        carry: bool = False,
        keepSource: bool = False,
        unitScale: float = 1.0,
        imageAsVolume: bool = False,
        margin: float | None = None,
        whole: bool = False,
        box: tuple[Place, Place] | None = None,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> PatchSource:
    """A file as a geometry texture: points, or any model, of which points are made. A PatchSource."""
    ...

def read_points(path: Path, *,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> PointCloud:
    """A file of points as it is: .ply, .xyz, .pcd, .npy and others; docs/formats.md lists them."""
    ...

def read_samples(files: Path | Mapping[str, Path] | Sequence[Path | Mapping[str, Path]], tile: Literal['auto', 'yes', 'no'] = 'auto', *,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> list[TextureSample]:
    """Samples from pictures, a list of TextureSample: one path or several, or dicts of maps {'Cd': path, 'roughness': path}.
    tile: whether they continue at their opposite borders; 'auto': where these match."""
    ...

def read_target(path: Path, kind: Literal['points', 'mesh', 'levelset'] | None = None, *,
        voxelSize: float = 0.0,
        resolution: int = 0,
        halfWidth: float = 3.0,
        open: Literal['close', 'shell'] = 'close',
        thickness: float = 0.0,
        exact: bool = False,
        grid: str = '',
        iso: float | None = None,
        pixelSize: float = 0.0,
        pixelSides: Place = (0.0, 0.0, 0.0),
        height: float = 0.0,
        base: float = 0.0,
        plane: Plane = 'xy',
        threshold: float | None = None,
        below: float | None = None,
        labels: Sequence[float | tuple[float, float]] = (),
        carry: bool = False,
        keepSource: bool = False,
        unitScale: float = 1.0,
        imageAsVolume: bool = False,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> TextureTarget:
    """A file as a target of texturing: 'points', 'mesh' or 'levelset'; None: by extension, as vdb_synth texture takes it."""
    ...

def relief(samples: LevelSet | Heights | Sequence[LevelSet | Heights], target: LevelSet, labels: Labels = None, *,
        method: Literal['default', 'paper'] = 'default',
        base: Literal['twicing', 'gaussian', 'flow', 'normals', 'quadrics'] = 'twicing',
        baseRadius: float = 0.0,
        wholeSample: bool = False,
        scale: float = 1.0,
        strength: float = 1.0,
        minWall: float = 0.0,
        direction: Direction | None = None,
        exemplarDirection: Direction | None = None,
        levels: int = 0,
        passes: int = 2,
        coarsePasses: int = 4,
        similar: int = 2,
        coherence: float = 2.0,
        uniformity: float = 0.25,
        histogram: float = 0.75,
        maxRotation: float = 60.0,
        neighbourhood: float = 0.0,
        top: float = 0.02,
        mask: GridLike | None = None,
        maskModel: LevelSet | None = None,
        maskAttribute: str = '',
        maskImage: NDArray[Any] | None = None,
        fade: float = 0.0,
        fit: bool = False,
        halfWidth: float = 3.0,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> ReliefResult:
    """Grows the relief of samples (LevelSet scans or Heights, one or a list) on a target: a ReliefResult. labels: of several
    samples which goes where, as texture takes it."""
    ...

def relief_extract(model: LevelSet, *,
        base: Literal['twicing', 'gaussian', 'flow', 'normals', 'quadrics'] = 'twicing',
        baseRadius: float = 0.0,
        strength: float | None = None,
        halfWidth: float = 3.0,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> ReliefExtraction:
    """Splits a scan into a smooth base and the relief on it: a ReliefExtraction."""
    ...

def render(models: LevelSet | GridLike | Sequence[LevelSet | GridLike | Sequence[GridLike]], outputs: Path | Sequence[Path] | None = None, *,
        size: Sequence[int] = (800, 600),
        view: Place | None = None,
        up: Literal['y', 'z'] | None = None,
        slice: str | tuple[str, float] | None = None,
        turntable: int = 0,
        captions: Sequence[str] = (),
        columns: int = 64,
        sameScale: bool = False,
        background: str = 'studio',
        ground: bool = True,
        wireframe: bool = False,
        color: str = '',
        density: float = 1.0,
        samples: int = 4,
        directions: GridLike | None = None,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> NDArray[Any]:
    """Draws models side by side: a picture as uint8 [rows, columns, channels], the top row first, red, green, blue and, on
    a transparent background, opacity (not multiplied into the colours); of a turntable [pictures, rows, columns,
    channels]. A model is a LevelSet, with its attributes, or fog: a Grid of densities, or a list of it and its other
    grids, such as Cd. `outputs`: a .png or a list of them, written as well; of a turntable with #### for a picture's number."""
    ...

def repeat(map: SourceMap, inputs: LevelSet | Sequence[LevelSet], *,
        carried: Literal['copied', 'blended'] = 'copied',
        halfWidth: float = 0.0,
        origin: Place | None = None,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> LevelSet:
    """Applies a source map to models, without any search: the exemplars of a synthesis; those of a fill, then the kept
    model; of an analogy the textured models, then the target."""
    ...

def repeat_patch(map: Path, exemplar: Path, *,
        plane: Plane | None = None,
        voxelSize: float = 0.0,
        resolution: int = 0,
        halfWidth: float = 3.0,
        open: Literal['close', 'shell'] = 'close',
        thickness: float = 0.0,
        exact: bool = False,
        grid: str = '',
        iso: float | None = None,
        pixelSize: float = 0.0,
        pixelSides: Place = (0.0, 0.0, 0.0),
        height: float = 0.0,
        base: float = 0.0,
        threshold: float | None = None,
        below: float | None = None,
        labels: Sequence[float | tuple[float, float]] = (),
        carry: bool = False,
        keepSource: bool = False,
        unitScale: float = 1.0,
        imageAsVolume: bool = False,
        margin: float | None = None,
        whole: bool = False,
        box: tuple[Place, Place] | None = None,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> PatchSheet | PatchedModel:
    """The arrangement of a map of patches (a .vdb of map_grids) with the exemplar in a file: a PatchSheet or PatchedModel."""
    ...

def repeat_texture(path: Path, samples: TextureSample | Sequence[TextureSample], *,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> Texture:
    """The coordinates of a textured .ply read in other samples of the same layout: a Texture."""
    ...

def synth(exemplars: LevelSet | Sequence[LevelSet], *,
        size: Size = '2x,2x,2x',
        exemplarBox: Box | None = None,
        border: Border | Sequence[Border | None] | None = None,
        origin: Place | None = None,
        block: int = 0,
        levels: int = 0,
        drift: int = 0,
        method: Literal['default', 'exact', 'paper'] = 'default',
        draft: bool = False,
        exemplarMask: GridLike | None = None,
        exemplarMap: GridLike | None = None,
        rotationMap: GridLike | None = None,
        direction: Direction | None = None,
        exemplarDirection: Direction | None = None,
        scaleMap: GridLike | None = None,
        guide: GridLike | None = None,
        exemplarGuides: Sequence[GridLike] = (),
        guideWeight: float = 4.0,
        longestRun: float = 0.3,
        indexCache: str = '',
        halfWidth: float = 3.0,
        carried: Literal['copied', 'blended'] = 'copied',
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> SynthResult:
    """More geometry that looks like the exemplar, one LevelSet or a list: SynthResult(model, map, stats)."""
    ...

def texture(target: TextureTarget | LevelSet | Mesh | PointCloud, samples: TextureSample | Sequence[TextureSample], labels: Labels = None, *,
        method: Literal['default', 'parameterize', 'match', 'hybrid'] = 'default',
        scale: float = 1.0,
        direction: Direction | None = None,
        levels: int = 0,
        passes: int = 2,
        coarsePasses: int = 4,
        similar: int = 2,
        coherence: float = 2.0,
        uniformity: float = 0.25,
        histogram: float = 0.75,
        maxRotation: float = 60.0,
        blend: Literal['automatic', 'off', 'weight', 'histogram'] = 'automatic',
        regionBlend: float = 0.0,
        neighbours: int = 25,
        coherent: bool = False,
        matchSample: int = 0,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> Texture:
    """Colours a target (TextureTarget, LevelSet, Mesh or PointCloud) like one TextureSample or several: a Texture.
    labels: which sample goes where: 'auto' (by shape), a LevelSet (1 inside), a Grid of numbers, the name of an attribute,
    or an array of numbers, one a site."""
    ...

def write_grids(path: Path, grids: Sequence[GridLike], metadata: Mapping[str, str] = {}, *,
        seed: int = 0,
        threads: int = 0,
        maxMemory: int = 0,
        onProgress: Callable[[str, int, int], object] | None = None,
        onMessage: Callable[[str, str], object] | None = None,
        cancel: Event | None = None) -> None:
    """Writes grids to a VDB file, which appears whole or not at all. Equal grids and metadata give equal bytes."""
    ...
