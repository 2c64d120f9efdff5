// Options of patch.
#include "tools/vdb_synth/option_makers.h"
#include "tools/vdb_synth/options.h"

namespace vdbsynth::cli {
namespace {

const std::vector<std::string> kPatch{"patch"};

std::vector<Option> sheetTable() {
    return {
        option(Kind::SheetSizes, "size", "X,Y")
            .says(
                "size of the sheet along its plane (world), or multiples of the exemplar's box such as 4x,4x")
            .sets({"size", "width", "depth"})
            .takenBy(kPatch),
        choice("method", "NAME",
               {{"default", "place, cut, warp along the cuts, blend"}, {"paper", "as published in 2006"}})
            .in(Group::Method)
            .says("how patches come together")
            .initially("default")
            .takenBy(kPatch),
        worldLength("patch", "W")
            .in(Group::Method)
            .says("side of a patch")
            .otherwiseIs("one and a half features of the exemplar")
            .takenBy(kPatch),
        real("overlap", "SHARE", 0.05, 0.8)
            .in(Group::Method)
            .says("how far a patch reaches over earlier ones, as a share of its side")
            .otherwiseIs("a third")
            .takenBy(kPatch),
        real("tolerance", "E", 0, 10)
            .in(Group::Method)
            .says("patches that fit within 1 + E times as well as the best are drawn from")
            .initially("0.1")
            .takenBy(kPatch),
        real("field-step", "S", 0.5, 64)
            .in(Group::Method)
            .says("how far apart distances are measured that patches are compared by, in spacings of the "
                  "points")
            .otherwiseIs("2, or more where the exemplar is over 72 steps wide")
            .sets({"step"})
            .takenBy(kPatch),
        whole("repairs", "N", 0, 20)
            .in(Group::Method)
            .says("rounds in which patches are laid over the worst seams, of --method default")
            .initially("2")
            .takenBy(kPatch),
        flag("tile")
            .in(Group::Method)
            .says("let the sheet continue at its opposite sides, of --method default")
            .takenBy(kPatch),
        flag("draft")
            .in(Group::Method)
            .says("a quick look: coarser comparison, no repairs, nothing warped or blended, of --method "
                  "default")
            .takenBy(kPatch),
        choice("plane", "PLANE", {{"xy", ""}, {"yz", ""}, {"zx", ""}})
            .in(Group::Input)
            .says("plane along which the exemplar is a sheet")
            .otherwiseIs("the file's own, else across its shortest side")
            .takenBy(kPatch),
        output("output", "FILE", {})
            .shortly('o')
            .says("file to write, its kind by extension: .ply points with normals; .vdb level set; .obj, "
                  ".stl, .off, .glb, .gltf, "
                  ".3mf mesh; .png, .exr heights")
            .repeatable()
            .takenBy(kPatch),
        output("source-map", "FILE.vdb", {"vdb"})
            .says("write which patch every place is from, for repeat, of --method default")
            .takenBy(kPatch),
        real("margin", "W", 0)
            .in(Group::Input)
            .measuredIn(Unit::World)
            .says("how much of the exemplar at its sides only says how it continues")
            .otherwiseIs("what the file says, else a third of a patch")
            .takenBy(kPatch),
    };
}

std::vector<Option> paperTable() {
    const auto weight = [](const char* name, const char* of) {
        return real(name, "W", 0, 1e6)
            .in(Group::Method)
            .says(std::string("weight of ") + of +
                  " in pairing, of --method paper; lengths count in spacings")
            .otherwiseIs("from the exemplar's own near matches")
            .takenBy(kPatch);
    };
    return {
        weight("weight-normal", "normals"),
        weight("weight-variation", "surface variation"),
        weight("weight-length", "the pairs' length against their neighbours'"),
        weight("weight-direction", "the pairs' direction against their neighbours'"),
        real("limit-position", "L", 0.1, 100)
            .in(Group::Method)
            .says("longest pair, of --method paper, in spacings of the points")
            .initially("6")
            .takenBy(kPatch),
        real("limit-normal", "DEGREES", 0, 180)
            .in(Group::Method)
            .says("greatest angle between the normals of a pair, of --method paper")
            .initially("60")
            .takenBy(kPatch),
        real("limit-variation", "V", 0, 1)
            .in(Group::Method)
            .says("greatest difference of surface variation of a pair, of --method paper")
            .initially("0.1")
            .takenBy(kPatch),
        whole("pairing-rounds", "N", 0, 20)
            .in(Group::Method)
            .says("times that points are paired again, of --method paper")
            .initially("3")
            .sets({"rounds"})
            .takenBy(kPatch),
        option(Kind::Triple, "seed-patch", "X,Y,Z")
            .in(Group::Method)
            .measuredIn(Unit::World)
            .says("minimum corner of the first patch in the exemplar, of --method paper")
            .otherwiseIs("drawn by --seed")
            .sets({"seedPlace"})
            .takenBy(kPatch),
    };
}

std::vector<Option> repairTable() {
    return {
        option(Kind::Hole, "hole", "MODEL|BOX")
            .measuredIn(Unit::World)
            .says("repair a sheet instead of making a larger one: replace what is inside a model or a box "
                  "x,y,z,X,Y,Z, through the sheet's whole height")
            .takenBy(kPatch),
        option(Kind::Model, "keep", "SHEET")
            .says("the sheet to repair with --hole, when EXEMPLAR is to be copied from")
            .noting("without it the input is the sheet, and its own exemplar")
            .takenBy(kPatch),
    };
}

std::vector<Option> ontoTable() {
    return {
        option(Kind::Model, "onto", "MODEL")
            .says("lay the exemplar over the surface of a model in place of a sheet")
            .noting("a mesh or points become a level set of voxels half a field step wide")
            .takenBy(kPatch),
        real("scale", "S", 0.001, 1000)
            .in(Group::Controls)
            .says("size of the exemplar, with --onto")
            .initially("1")
            .takenBy(kPatch),
        real("height-offset", "W")
            .in(Group::Controls)
            .measuredIn(Unit::World)
            .says("how far outward of MODEL's surface the middle of the exemplar's height lies, with --onto")
            .initially("0")
            .takenBy(kPatch),
        flag("with-model")
            .in(Group::Output)
            .says("unite level sets and meshes with MODEL, with --onto")
            .takenBy(kPatch),
    };
}

}  // namespace

std::vector<Option> patchOptionTable() {
    std::vector<Option> table = sheetTable();
    for (const auto& more : {repairTable(), ontoTable(), paperTable()})
        table.insert(table.end(), more.begin(), more.end());
    return table;
}

}  // namespace vdbsynth::cli
