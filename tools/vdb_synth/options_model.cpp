// Options of models as inputs, and of what is written.
#include "tools/vdb_synth/option_makers.h"
#include "tools/vdb_synth/options.h"

#include <algorithm>

namespace vdbsynth::cli {
namespace {

using Names = std::vector<std::string>;

// Commands that take any geometry and convert it to a level set.
const Names kModel{"convert", "crop",    "mask",   "match", "synth",  "analogy",       "texture",
                   "repeat",  "compare", "render", "patch", "relief", "relief-extract"};

// The relief commands have a base of their own.
const Names kWithImageBase(kModel.begin(), kModel.end() - 2);

// Patch has a plane of its own.
const Names kWithImagePlane = [] {
    Names names = kModel;
    names.erase(std::find(names.begin(), names.end(), "patch"));
    return names;
}();

std::vector<Option> inputTable() {
    const auto with = [](Names names, const Names& more) {
        names.insert(names.end(), more.begin(), more.end());
        return names;
    };
    return {
        worldLength("voxel-size", "W")
            .in(Group::Input)
            .says("side of a voxel")
            .noting("a VDB is resampled")
            .takenBy(with(kModel, {"make"}))
            .butFor("make", [](Option& o) { o.initially("1").noting("").in(Group::Result); })
            .butFor("mask", [](Option& o) { o.otherwiseIs("1 for box and ball"); })
            .butFor("analogy", [](Option& o) { o.says("side of a voxel of B"); })
            .butFor("relief", [](Option& o) { o.says("side of a voxel of TARGET"); })
            .butFor("texture",
                    [](Option& o) { o.says("side of a voxel of a level set, or of OpenVDB points"); })
            .butFor("repeat",
                    [](Option& o) {
                        o.says("side of a voxel of the exemplars, for a map of synth")
                            .otherwiseIs("a VDB's own, else the map's")
                            .noting("other maps fix their own voxel sizes");
                    }),
        whole("resolution", "N", 2, 100000)
            .in(Group::Input)
            .says("voxels along the longest side")
            .otherwiseIs("128 for meshes and points, an image's pixels, a volume's cells")
            .takenBy(with(kModel, {"make"}))
            .butFor("make",
                    [](Option& o) { o.from(16, 4096).initially("64").otherwiseIs("").in(Group::Result); })
            .butFor("analogy", [](Option& o) { o.says("voxels along the longest side of B"); })
            .butFor("relief", [](Option& o) { o.says("voxels along the longest side of TARGET"); })
            .butFor("texture",
                    [](Option& o) {
                        o.says("voxels along the longest side of a level set made from the target");
                    })
            .butFor("repeat",
                    [](Option& o) {
                        o.says("voxels along the longest side of the exemplars, for a map of synth")
                            .otherwiseIs("a VDB's own voxels, else the map's");
                    }),
        whole("exemplar-resolution", "N", 2, 100000)
            .in(Group::Input)
            .says("voxels along the longest side of a mesh A")
            .otherwiseIs("128")
            .noting("A2 has A's voxels")
            .takenBy({"analogy", "relief"})
            .butFor("relief",
                    [](Option& o) {
                        o.says("voxels along the longest side of a SAMPLE")
                            .noting("a voxel of it lands on one of TARGET, times --scale");
                    }),
        option(Kind::Text, "grid", "NAME")
            .in(Group::Input)
            .says("which grid of a VDB file, or array, channel or frame of a volume or image")
            .otherwiseIs(
                "surface, else the first level set, else with --iso a fog volume; of images the first")
            .sets({"grid", "gridName"})
            .takenBy(with(kModel, {"info"}))
            .butFor("analogy", [](Option& o) { o.says("which grid or array of B"); }),
        real("iso", "VALUE")
            .in(Group::Input)
            .says("a fog volume is solid above this value")
            .takenBy(with(kModel, {"info"})),
        real("unit-scale", "S", 1e-12, 1e12)
            .in(Group::Input)
            .says("multiplies the file's coordinates: 1000 reads metres as millimetres")
            .initially("1")
            .takenBy(kModel),
        choice("open", "KIND", {{"close", ""}, {"shell", "of --thickness around its faces or points"}})
            .in(Group::Input)
            .says("how to treat input that is not watertight")
            .initially("close")
            .takenBy(kModel),
        worldLength("thickness", "W")
            .in(Group::Input)
            .says("shell thickness")
            .noting("with --open shell")

            .takenBy(kModel),
        real("half-width", "V", 1.5, 100)
            .in(Group::Output)
            .measuredIn(Unit::Voxels)
            .says("half-width of the narrow band of the result")
            .initially("3")
            .takenBy({"convert", "crop", "synth", "analogy", "texture", "repeat", "make", "relief",
                      "relief-extract", "patch"})
            .butFor("repeat",
                    [](Option& o) { o.initially("").otherwiseIs("that of the run that wrote the map"); }),
        option(Kind::Text, "name", "NAME")
            .in(Group::Output)
            .says("name of the level set's grid in .vdb outputs")
            .otherwiseIs("surface")
            .takenBy({"convert", "crop", "synth", "analogy", "repeat", "make", "relief"}),
        flag("half")
            .in(Group::Output)
            .sets({"halfFloats"})
            .says("write the level set and the transferred grids at half precision; source maps stay exact")
            .takenBy({"convert", "crop", "synth", "analogy", "repeat", "make", "relief"}),
        choice("values", "VALUES",
               {{"inside", "1 in the solid, 0 outside, as bytes"},
                {"distance", "world units, negative inside, to the end of the band"},
                {"density", "fog, 0.5 at the surface"}})
            .in(Group::Output)
            .says("what a volume output holds")
            .initially("inside")
            .takenBy({"convert", "crop", "synth", "analogy", "repeat", "make", "relief"}),
    };
}

std::vector<Option> rasterTable() {
    return {
        option(Kind::Lengths, "pixel-size", "P[,Y[,Z]]")
            .from(kAboveZero, kUnbounded)
            .measuredIn(Unit::World)
            .in(Group::Raster)
            .says("side of an image's pixel or of a volume's smallest cell; with commas along columns, rows "
                  "and, for volumes, slices")
            .otherwiseIs("the file's, else 1")
            .sets({"pixelSize", "pixelSides"})
            .takenBy(kModel)
            .butFor("relief",
                    [](Option& o) {
                        o.says("side of a pixel of a picture on TARGET")
                            .otherwiseIs("a voxel of TARGET, times --scale");
                    }),
        worldLength("height", "H")
            .in(Group::Raster)
            .says("height of white above black, or of the highest value above the lowest")
            .otherwiseIs("a tenth of the longer side, real values as they are")
            .takenBy(kModel)
            .butFor("relief",
                    [](Option& o) {
                        o.says("height of white above black, of a picture as SAMPLE")
                            .otherwiseIs("5 voxels of TARGET, times --scale");
                    }),
        worldLength("base", "B")
            .in(Group::Raster)
            .says("thickness of the solid under an image's lowest point")
            .otherwiseIs("a 20th of its longer side")
            .takenBy(kWithImageBase),
        choice("plane", "PLANE", {{"xy", ""}, {"yz", ""}, {"zx", ""}})
            .in(Group::Raster)
            .says("plane of an image")
            .initially("xy")
            .noting("heights go along the third axis")
            .takenBy(kWithImagePlane),
        real("threshold", "VALUE")
            .in(Group::Raster)
            .says("a volume (npy, tif, vti, nii ...) is solid above this value")
            .takenBy(kModel),
        real("below", "VALUE")
            .in(Group::Raster)
            .says("a volume is solid below this value, such as 0 of distances")
            .takenBy(kModel),
        option(Kind::Labels, "labels", "LIST")
            .in(Group::Raster)
            .says("a volume is solid where it has one of these values, for example 1,4,10-20")
            .takenBy(kModel),
    };
}

std::vector<Option> outputTable() {
    const Names json{"info", "match", "compare", "doctor"};
    Option map = output("source-map", "[FILE.vdb]", {"vdb"});
    map.valueOptional = true;
    return {
        output("output", "FILE", {})
            .shortly('o')
            .says("file to write, its kind by extension: .vdb, .obj, .ply, .stl, .off, .glb, .gltf, .3mf; "
                  "heights as .png or .exr; volumes as .npy, .tif, .vti, .nii or .nii.gz")
            .repeatable()
            .takenBy({"convert", "crop", "synth", "analogy", "repeat", "make", "relief"})
            .butFor(
                "make",
                [](Option& o) {
                    o.noting(
                        "a .ply of a texture holds points, which continue beyond the domain without caps");
                }),
        output("output", "FILE", {"ply", "obj", "off", "glb", "gltf", "3mf", "vdb", "png", "exr"})
            .shortly('o')
            .says("file to write, its kind by extension: .ply points or mesh, .obj, .off, .glb, .gltf, .3mf "
                  "mesh, "
                  ".vdb level set or points; with --bake .png, .exr pictures")
            .repeatable()
            .takenBy({"texture"}),
        output("output", "FILE.vdb", {"vdb"}).shortly('o').says("mask to write").takenBy({"mask"}),
        output("output", "FILE.json", {"json"})
            .shortly('o')
            .says("write the answer as JSON to this file, and nothing to standard output")
            .takenBy(json),
        flag("json")
            .in(Group::Output)
            .ofTheRun()
            .says("print JSON instead of text")
            .takenBy({"info", "compare", "doctor"}),
        flag("json")
            .in(Group::Output)
            .ofTheRun()
            .says("print JSON (the default and only form)")
            .takenBy({"match"}),
        output("page", "FILE.html", {"html", "htm"})
            .says("also write a page with pictures, curves and verdicts")
            .takenBy({"compare"}),
        choice("as", "KIND",
               {{"auto", "by extension; a .ply is a mesh"},
                {"mesh", ""},
                {"points", ""},
                {"levelset", ""},
                {"heightfield", ""},
                {"volume", "also reads an image as a volume"}})
            .in(Group::Output)
            .orAnExtension()
            .says("what to write")
            .noting("for standard input also the extension of its kind, such as obj")
            .initially("auto")
            .sets({"as", "imageAsVolume", "points"})
            .setsBy("volume", "imageAsVolume")
            .setsBy("points", "points")
            .takenBy({"convert"}),
        choice("as", "KIND",
               {{"auto", "by extension; a .ply is points"}, {"mesh", ""}, {"points", ""}, {"levelset", ""}})
            .in(Group::Output)
            .orAnExtension()
            .says("what to take the target as")
            .noting("for standard input also the extension of its kind, such as obj")
            .initially("auto")
            .takenBy({"texture"}),
        flag("bake")
            .in(Group::Output)
            .says(
                "bake .png and .exr outputs onto the target's own texture coordinates: the map that ends the "
                "file's name (x_roughness.png), else the colour; <UDIM> in a name writes a picture for each "
                "tile")
            .takenBy({"texture", "repeat", "relief"})
            .butFor("relief",
                    [](Option& o) {
                        o.says(
                            "bake .png and .exr outputs onto TARGET's own texture coordinates: x_normal.png "
                            "holds normals, x_vector.exr vectors along u, v and normal, other names the "
                            "displacement along the normal; <UDIM> in a name writes a picture for each tile");
                    }),
        whole("bake-size", "N", 16, 16384)
            .in(Group::Output)
            .measuredIn(Unit::Pixels)
            .says("side of a baked picture")
            .initially("1024")
            .takenBy({"texture", "repeat", "relief"}),
        choice("bake-bits", "BITS", {{"8", ""}, {"16", ""}})
            .in(Group::Output)
            .says("bits of a value in a baked .png")
            .initially("8")
            .takenBy({"texture", "repeat", "relief"})
            .butFor("relief", [](Option& o) { o.initially("16"); }),
        real("adaptivity", "A", 0, 1)
            .in(Group::Output)
            .says("merge flat parts of a mesh output")
            .initially("0")
            .noting("0 keeps all faces")
            .takenBy({"convert", "synth", "analogy", "repeat", "relief", "patch"}),
        flag("sharp")
            .in(Group::Output)
            .says(
                "keep sharp edges and corners in a mesh output, taken from the input's faces if it is a mesh")
            .takenBy({"convert"}),
        real("spacing", "S", 0.25, 100)
            .in(Group::Output)
            .measuredIn(Unit::Voxels)
            .says("least distance between points written")
            .initially("1")
            .takenBy({"convert", "make"})
            .butFor("make",
                    [](Option& o) {
                        o.from(0.125, 100)
                            .says("least distance between the points of a .ply")
                            .initially("")
                            .otherwiseIs("a quarter of the radius of the kind's finest parts, 0.25 to 1");
                    }),
        option(Kind::Text, "carry", "NAMES")
            .in(Group::Output)
            .says("attributes and grids of the exemplar to transfer: all, or names with commas")
            .initially("all")
            .takenBy({"synth", "analogy", "repeat"})
            .butFor("analogy",
                    [](Option& o) {
                        o.says("attributes and grids of A2 to transfer: all, or names with commas");
                    }),
        flag("carry-blend")
            .in(Group::Output)
            .says("transfer weighted means of numbers and vectors instead of copies")
            .sets({"carried", "carryBlend"})
            .takenBy({"synth", "repeat"})
            .butFor("repeat", [](Option& o) { o.noting("only with a map of synth without --keep"); }),
        map.says("also write the source map: where each voxel was copied from")
            .noting("without FILE into the .vdb output")
            .takenBy({"synth", "analogy"}),
        choice("map-types", "TYPES",
               {{"integer", ""},
                {"float", "for readers without integer vectors, such as Debian's Python module"}})
            .in(Group::Output)
            .says("types of the source map's grids")
            .initially("integer")
            .takenBy({"synth", "analogy"}),
        flag("write-directions")
            .in(Group::Output)
            .says("also write the direction field into .vdb outputs, as the grid direction")
            .sets({"keepDirections", "writeDirections"})
            .takenBy({"analogy"}),
    };
}

}  // namespace

std::vector<Option> modelOptionTable() {
    std::vector<Option> table = outputTable();
    for (const auto& more : {inputTable(), rasterTable()})
        table.insert(table.end(), more.begin(), more.end());
    return table;
}

}  // namespace vdbsynth::cli
