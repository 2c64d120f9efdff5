// Options of relief.
#include "tools/vdb_synth/option_makers.h"
#include "tools/vdb_synth/options.h"

namespace vdbsynth::cli {

std::vector<Option> reliefOptionTable() {
    const std::vector<std::string> relief{"relief"};
    return {
        choice("method", "NAME",
               {{"default", "coordinates corrected coarse to fine"},
                {"paper", "vertex by vertex, exhaustive, as published in 2006 (slow)"}})
            .in(Group::Method)
            .says("how to grow the relief")
            .initially("default")
            .takenBy(relief),
        real("neighbourhood", "R", kAboveZero)
            .in(Group::Method)
            .measuredIn(Unit::World)
            .says("radius of what the paper's method compares, about half the size of a feature")
            .otherwiseIs("4 voxels of TARGET")
            .takenBy(relief),
        real("top", "P", 0, 100)
            .in(Group::Method)
            .says("percent of the sample's vertices among which the paper's method draws")
            .initially("0.02")
            .takenBy(relief),
        flag("whole-sample")
            .in(Group::Controls)
            .says("copy also from the plain parts of a scan; else from where its relief is at least half as "
                  "high as "
                  "where it is highest")
            .takenBy(relief),
        real("scale", "S", 0.05, 20)
            .in(Group::Controls)
            .says("size of the relief; at 1 a voxel of SAMPLE, or a pixel, lands on a voxel of TARGET")
            .initially("1")
            .takenBy(relief),
        real("strength", "T", -100, 100)
            .in(Group::Controls)
            .says("height of the relief: 1 as the sample's, 2 twice, below 0 inverted")
            .initially("1")
            .takenBy(relief),
        worldLength("min-wall", "W")
            .in(Group::Controls)
            .says("least thickness that carving leaves of thin parts of TARGET")
            .otherwiseIs("0, nothing kept")
            .takenBy(relief),
        worldLength("fade", "W")
            .in(Group::Controls)
            .says("depth inside a model given as --mask over which the relief rises to its full height")
            .otherwiseIs("0, at once")
            .takenBy(relief),
        option(Kind::Text, "mask-attribute", "NAME")
            .in(Group::Controls)
            .says("where to put the relief, as painted on TARGET's vertices: an attribute from 0 to 1, of a "
                  "colour "
                  "(Cd) the mean of its channels")
            .takenBy(relief),
        file("mask-image", "FILE", {"png", "jpg", "jpeg", "tif", "tiff", "exr", "pgm", "ppm"})
            .in(Group::Controls)
            .says("where to put the relief, as painted on TARGET's texture coordinates: white is all of it")
            .takenBy(relief),
        flag("fit")
            .in(Group::Controls)
            .says("resize a tileable picture by the least that makes whole periods go round TARGET, so that "
                  "the "
                  "pattern closes; with --direction around:AXIS")
            .takenBy(relief),
    };
}

}  // namespace vdbsynth::cli
