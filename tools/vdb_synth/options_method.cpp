// Options of single commands: result, method and controls.
#include "tools/vdb_synth/option_makers.h"
#include "tools/vdb_synth/options.h"

namespace vdbsynth::cli {
namespace {

std::vector<Option> resultTable() {
    return {
        option(Kind::Sizes, "size", "X,Y,Z")
            .says("size of the result: voxels, multiples of the exemplar's domain such as 2x,2x,1x, or "
                  "lengths such "
                  "as 2.5w (world)")
            .takenBy({"synth"}),
        option(Kind::Triple, "origin", "X,Y,Z")
            .measuredIn(Unit::World)
            .says("where the result's minimum corner goes, half a voxel outside its first voxel's centre")
            .otherwiseIs("where that of the exemplar's domain is")
            .takenBy({"synth", "repeat"})
            .butFor("repeat",
                    [](Option& o) {
                        o.says(
                             "of a map of synth: where the result's minimum corner goes, half a voxel "
                             "outside its "
                             "first voxel's centre")
                            .otherwiseIs("as far from the exemplar's as in the map's run");
                    }),
        option(Kind::WholeTriple, "size", "X,Y,Z")
            .from(8, 4096)
            .measuredIn(Unit::Voxels)
            .says("size of the domain, each side")
            .otherwiseIs("a cube of --resolution, lower for flat kinds")
            .takenBy({"make"}),
        real("feature", "F", 4, 256)
            .measuredIn(Unit::Voxels)
            .says("size of a typical feature")
            .otherwiseIs("the kind's own")
            .noting("a larger domain holds more of them")
            .takenBy({"make"}),
        real("margin", "V", 0, 4000)
            .measuredIn(Unit::Voxels)
            .says("how far the points of a .ply extend beyond the domain")
            .otherwiseIs("two thirds of the feature: a third of a patch of two features")
            .takenBy({"make"}),
        axisChoices("border", "KIND",
                    {{"cut", ""}, {"object", ""}, {"tile", "the result repeats without a seam"}})
            .says("how the result ends along an axis that grows")
            .otherwiseIs("cut where a domain is recorded or a clip left the model cut open, else object")
            .takenBy({"synth"}),
        option(Kind::Box, "box", "BOX")
            .says("i,j,k,I,J,K: voxels in index space, both corners inclusive, or lengths such as 1.5w "
                  "(world): "
                  "voxels with their centres from the lower up to, not on, the upper")
            .takenBy({"crop", "mask"})
            .butFor("mask",
                    [](Option& o) {
                        o.says(
                            "for box: i,j,k,I,J,K: voxels in index space, both corners inclusive, or lengths "
                            "such as 1.5w (world): voxels with their centres from the lower up to, not on, "
                            "the upper");
                    }),
        option(Kind::Triple, "center", "X,Y,Z")
            .measuredIn(Unit::World)
            .says("for ball: its centre")
            .takenBy({"mask"}),
        worldLength("radius", "R").says("for ball: its radius").takenBy({"mask"}),
        option(Kind::Range, "range", "LOW,HIGH")
            .sets({"range", "minimum", "maximum"})
            .says("for range: active voxels of --grid with a value from LOW to HIGH")
            .takenBy({"mask"}),
    };
}

std::vector<Option> synthTable() {
    return {
        whole("block", "N", 4, 256)
            .measuredIn(Unit::Voxels)
            .says("side of the matched blocks")
            .takenBy({"match", "synth"})
            .butFor("match", [](Option& o) { o.initially("16"); })
            .butFor("synth", [](Option& o) { o.otherwiseIs("from the exemplar, at most 16"); }),
        whole("levels", "N", 1, 8)
            .says("number of passes, coarse to fine")
            .otherwiseIs("3, more for larger exemplars, or as many as fit")
            .takenBy({"synth"}),
        choice("method", "NAME",
               {{"default", "texture optimization"},
                {"exact", "blocks in raster order, each an exact best match"},
                {"paper", "as published in 2004"}})
            .says("how to synthesize")
            .initially("default")
            .takenBy({"synth"}),
        flag("draft")
            .says("a quick look: search at half the resolution, distances are approximate")
            .takenBy({"synth", "analogy"})
            .butFor("analogy",
                    [](Option& o) {
                        o.says(
                            "a quick look: search at half the resolution, the texture is read at full "
                            "resolution");
                    }),
        whole("drift", "D", 0, 1 << 20)
            .measuredIn(Unit::Voxels)
            .says("how far a source may be from its destination along axes at 1x")
            .initially("0")
            .takenBy({"synth"}),
        real("longest-run", "S", 0.01, 1)
            .says("largest share of the exemplar to copy in one piece")
            .initially("0.3")
            .noting("smaller values copy less and give more seams")
            .takenBy({"synth"}),
        option(Kind::Folder, "index-cache", "FOLDER")
            .says("keep the search index of an exemplar in this folder and read it from there the next time")
            .sets({"indexFolder", "cacheFolder", "indexCache"})
            .takenBy({"match", "synth"}),
    };
}

std::vector<Option> controlTable() {
    return {
        option(Kind::Box, "exemplar-box", "BOX")
            .says("domain i,j,k,I,J,K: voxels in the exemplar's index space, both corners inclusive, or "
                  "lengths "
                  "such as 1.5w (world): voxels with their centres from the lower up to, not on, the upper")
            .takenBy({"synth"}),
        option(Kind::ModelOrGrid, "exemplar-mask", "FILE")
            .says("copy only from inside this model, or where this grid of a .vdb is active, in any voxels; "
                  "its "
                  "box is the domain (of the first exemplar)")
            .takenBy({"synth"}),
        option(Kind::ModelOrGrid, "exemplar-map", "FILE")
            .says("which exemplar to use where in the result: a .vdb grid of labels (0: the first exemplar), "
                  "or a model (inside: the second, outside: the first)")
            .was("which")
            .takenBy({"synth"}),
        grid("guide")
            .says(
                "scalar grid over the result; sources whose --exemplar-guide value is similar are preferred")
            .takenBy({"synth"}),
        grid("exemplar-guide")
            .says("the same scalar over the exemplar, once for each exemplar")
            .sets({"exemplarGuides", "exemplarGuide"})
            .repeatable()
            .takenBy({"synth"}),
        real("guide-weight", "W", 0.001, 1000)
            .says("weight of guide differences relative to shape differences")
            .initially("4")
            .takenBy({"synth"}),
        grid("rotation-map")
            .measuredIn(Unit::Radians)
            .says("grid over the result: rotation of the copied geometry, rotation vectors or angles about z")
            .sets({"rotation", "rotationMap"})
            .takenBy({"synth"}),
        grid("scale-map")
            .says("grid over the result: scale of the copied geometry, 0.25 to 4")
            .sets({"scale", "scaleMap"})
            .takenBy({"synth"}),
        option(Kind::Model, "keep", "PARTIAL")
            .says("fill the holes of this model instead of making a larger one")
            .noting("without EXEMPLAR the model is its own exemplar")
            .sets({"partial", "keep"})
            .takenBy({"synth"}),
        option(Kind::Hole, "hole", "MODEL|BOX|auto")
            .says("what to fill with --keep: the inside of a model, a box i,j,k,I,J,K of the kept model's "
                  "voxels (or world, with a w), or auto: 3 voxels around the surface that closed its open "
                  "edges")
            .takenBy({"synth"}),
    };
}

std::vector<Option> analogyTable() {
    return {
        option(Kind::Direction, "direction", "SPEC")
            .in(Group::Controls)
            .says("direction of the texture over B: axis:x, axis:-z, a vector x,y,z, around:y, radial, "
                  "curvature, a grid of "
                  "vectors or scalars FILE.vdb[:GRID], or strokes (world): .csv rows x,y,z,dx,dy,dz, .json, "
                  ".ply points with normals")
            .otherwiseIs("curvature")
            .takenBy({"analogy", "texture", "relief", "patch", "synth"})
            .butFor("synth",
                    [](Option& o) {
                        o.says(
                             "rotate the copied geometry along these directions, instead of --rotation-map: "
                             "axis:x, axis:-z, a vector x,y,z, around:y, radial, a grid of vectors or "
                             "scalars FILE.vdb[:GRID], or strokes (world): .csv rows x,y,z,dx,dy,dz, .json, "
                             ".ply points with normals")
                            .noting("not with --draft or --method exact")
                            .otherwiseIs("");
                    })
            .butFor(
                "patch",
                [](Option& o) {
                    o.says(
                         "direction of the exemplar's first axis over MODEL, with --onto: axis:x, axis:-z, "
                         "a vector x,y,z, around:y, radial, curvature, a grid of vectors or scalars "
                         "FILE.vdb[:GRID], or "
                         "strokes (world): .csv rows x,y,z,dx,dy,dz, .json, .ply points with normals")
                        .otherwiseIs("a smooth field");
                })
            .butFor(
                "relief",
                [](Option& o) {
                    o.says(
                         "direction of the sample's rows over TARGET: axis:x, axis:-z, a vector x,y,z, "
                         "around:y, radial, "
                         "curvature, a grid of vectors or scalars FILE.vdb[:GRID], or strokes (world): .csv "
                         "rows x,y,z,dx,dy,dz, .json, .ply points with normals")
                        .otherwiseIs("a smooth field");
                })
            .butFor("texture",
                    [](Option& o) {
                        o.says(
                             "direction of the images' rows over the target: axis:x, axis:-z, a vector "
                             "x,y,z, around:y, "
                             "radial, curvature, a grid of vectors or scalars FILE.vdb[:GRID], or strokes "
                             "(world): .csv "
                             "rows x,y,z,dx,dy,dz, .json, .ply points with normals")
                            .otherwiseIs("a smooth field");
                    }),
        option(Kind::Direction, "exemplar-direction", "SPEC")
            .in(Group::Controls)
            .says("direction of the texture over A, given in the same ways")
            .otherwiseIs("the grid direction that make wrote into A, else curvature")
            .takenBy({"analogy", "relief", "synth"})
            .butFor("synth",
                    [](Option& o) {
                        o.says("with --direction: the exemplar's own, an axis or a vector")
                            .otherwiseIs("the axis that make wrote into the exemplar, else axis:x");
                    })
            .butFor("relief",
                    [](Option& o) {
                        o.says("direction of the relief over a SAMPLE, given in the same ways")
                            .otherwiseIs("a smooth field");
                    }),
        option(Kind::Model, "rest", "MODEL")
            .in(Group::Controls)
            .says("B in its rest pose: the texture is made there and carried to B, so that it stays where it "
                  "is on "
                  "a surface that deforms; a mesh with B's faces, or any model where B is a .vdb with a grid "
                  "of vectors `rest` (places at rest, world); --direction and --mask are those of the rest "
                  "pose")
            .takenBy({"analogy"}),
        option(Kind::ModelOrGrid, "mask", "FILE")
            .in(Group::Controls)
            .says("where to put the texture: a grid of weights from 0 to 1, or the inside of a model; "
                  "elsewhere B's voxels keep their bits")
            .takenBy({"analogy", "relief"})
            .butFor(
                "relief",
                [](Option& o) {
                    o.says(
                        "where to put the relief: a grid of weights from 0 to 1, or the inside of a model; "
                        "elsewhere TARGET's voxels keep their bits");
                }),
        real("scale", "S", 0.25, 4)
            .in(Group::Controls)
            .says("size of the texture")
            .initially("1")
            .noting("2 is twice as large in B's voxels")
            .takenBy({"analogy"}),
        worldLength("texture-size", "W")
            .in(Group::Controls)
            .says(
                "length on B that the longest side of A's domain covers, instead of --scale: the same at any "
                "resolution of B")
            .takenBy({"analogy", "relief", "texture"})
            .butFor("texture",
                    [](Option& o) {
                        o.says(
                            "length on TARGET that the longest side of the first IMAGE covers, instead of "
                            "--scale: the same however far points are apart");
                    })
            .butFor("relief",
                    [](Option& o) {
                        o.says(
                            "length on TARGET that the longest side of the first SAMPLE covers, instead of "
                            "--scale: the same at any resolution of TARGET");
                    }),
        real("strength", "T", 0, 1)
            .in(Group::Controls)
            .says("blend from B to the result")
            .initially("1")
            .takenBy({"analogy"}),
        choice("thin", "HOW",
               {{"scale", "the depth follows the part's thickness"},
                {"keep", "such parts stay as they are"},
                {"as-is", "the whole depth, which may cut them through"}})
            .in(Group::Controls)
            .says("where B is thinner than the texture is deep")
            .initially("scale")
            .takenBy({"analogy"}),
        whole("levels", "N", 1, 6)
            .says("levels of the pyramid")
            .otherwiseIs("as many as still resolve the texture, at most 3")
            .takenBy({"analogy"}),
        whole("sweeps", "N", 1, 10).says("sweeps over every level").initially("2").takenBy({"analogy"}),
        odd("samples", "N", 3, 9)
            .says("side of a neighbourhood in samples, one per voxel")
            .initially("5")
            .sets({"half", "samples"})
            .takenBy({"analogy"}),
        odd("coarse-samples", "N", 3, 7)
            .says("the same at the next coarser level")
            .initially("3")
            .sets({"coarseHalf", "coarseSamples"})
            .takenBy({"analogy"}),
        whole("components", "N", 4, 256)
            .says("principal components a neighbourhood is reduced to")
            .initially("16")
            .takenBy({"analogy"}),
        real("coherence", "K", 0, 100)
            .says("preference for sources that continue a neighbour's over the nearest match")
            .initially("1")
            .takenBy({"analogy"}),
        flag("exact")
            .says("search the exact nearest match of the reduced features (slower)")
            .sets({"epsilon", "exact"})
            .takenBy({"analogy"}),
        flag("causal")
            .says("compare only voxels that the sweep has visited, as in the paper")
            .takenBy({"analogy"}),
        flag("straight")
            .says("straight cubes as neighbourhoods, as in the paper, instead of curvature-adapted ones")
            .sets({"curvatureAdapted", "straight"})
            .takenBy({"analogy"}),
        flag("naive")
            .says("axis-aligned neighbourhoods, the paper's first variant, for filters such as blur; scalar "
                  "grids (fog volumes) are filtered as scalars")
            .sets({"aligned", "naive"})
            .takenBy({"analogy"}),
    };
}

std::vector<Option> matchTable() {
    return {
        option(Kind::WholeTriple, "at", "I,J,K")
            .from(-kFarVoxel, kFarVoxel)
            .in(Group::Controls)
            .measuredIn(Unit::Voxels)
            .says("minimum corner of the block in QUERY's index space")
            .takenBy({"match"}),
        option(Kind::ModelOrGrid, "mask", "FILE")
            .in(Group::Controls)
            .says("compare only samples of QUERY inside this model, or where this grid of a .vdb is active, "
                  "in any voxels")
            .takenBy({"match"}),
        whole("count", "K", 1, 100000).says("number of matches").initially("1").takenBy({"match"}),
        real("tolerance", "E", 0, 100)
            .says("accept matches whose difference is at most 1 + E times the least")
            .initially("0")
            .noting("0 is exact")
            .takenBy({"match"}),
        flag("check")
            .says("with --tolerance: also search exactly and print how close the matches are (slower)")
            .takenBy({"match"}),
        option(Kind::Axes, "stationary", "AXES")
            .says("axes along which the reference is stationary: xyz, xy ... or none")
            .otherwiseIs(
                "those whose two faces cut about the same area of the solid, where a domain is recorded")
            .takenBy({"compare"}),
        option(Kind::Process, "process", "\"make KIND\"")
            .says("process that the reference is a sample of, such as \"make balls --feature 12\": compare "
                  "with fresh samples of it")
            .takenBy({"compare"}),
        flag("full")
            .says("measure thickness and pores on every voxel, of large models too (slower)")
            .otherwiseIs("over 10 million voxels on every second one, of all models alike")
            .takenBy({"compare"}),
        whole("fresh", "N", 2, 100)
            .says("number of fresh samples")
            .initially("10")
            .noting("with --process")
            .takenBy({"compare"}),
        worldLength("relief-radius", "R")
            .says("also compare relief: heights over a base of this radius, as relief-extract makes it")
            .takenBy({"compare"}),
        file("map", "FILE.vdb", {"vdb"})
            .says("source map of OTHER")
            .otherwiseIs("the one in OTHER")
            .takenBy({"compare"}),
    };
}

}  // namespace

std::vector<Option> methodOptionTable() {
    std::vector<Option> table = resultTable();
    const auto append = [&table](std::vector<Option> more, Group group) {
        for (Option& option : more)
            table.push_back(option.group == Group::Result ? option.in(group) : option);
    };
    append(synthTable(), Group::Method);
    append(analogyTable(), Group::Method);
    append(matchTable(), Group::Method);
    append(controlTable(), Group::Controls);
    return table;
}

}  // namespace vdbsynth::cli
