// Options of relief-extract.
#include "tools/vdb_synth/option_makers.h"
#include "tools/vdb_synth/options.h"

namespace vdbsynth::cli {

std::vector<Option> reliefExtractOptionTable() {
    const std::vector<std::string> extract{"relief-extract"}, both{"relief", "relief-extract"};
    return {
        choice("base", "KIND",
               {{"twicing", "a Gaussian mean, corrected so that curved surfaces stay"},
                {"gaussian", "a Gaussian mean; shrinks what is round"},
                {"flow", "mean curvature flow; shrinks what is round"},
                {"normals", "means of normals that keep edges, for CAD parts"},
                {"quadrics", "local quadrics, as published in 2006"}})
            .in(Group::Method)
            .says("how the smooth base is made")
            .initially("twicing")
            .sets({"base", "kind"})
            .takenBy(both),
        worldLength("base-radius", "R")
            .in(Group::Method)
            .says("radius of the base: standard deviation of its Gaussian; the ISO 16610 cut-off wavelength "
                  "is 5.34 "
                  "times that")
            .otherwiseIs("where the spectrum of the relief has its gap; -v says why")
            .sets({"baseRadius", "radius"})
            .takenBy(both),
        real("strength", "S", -100, 100)
            .in(Group::Output)
            .says(
                "also make the grid surface = base + S * relief: 1 the scan, 0 the base, over 1 exaggerated, "
                "below 0 inverted; meshes (.obj, .stl, .off, .glb, .gltf) hold it")
            .takenBy(extract),
        output("output", "FILE", {"vdb", "ply", "png", "exr", "obj", "stl", "off", "glb", "gltf"})
            .shortly('o')
            .says("file to write, its kind by extension: .vdb grids base, relief and relief_vector; .ply the "
                  "base with "
                  "relief and relief_vector at its vertices; .png, .exr heights of a flat model; with "
                  "--strength "
                  "meshes of the surface")
            .repeatable()
            .takenBy(extract),
    };
}

}  // namespace vdbsynth::cli
