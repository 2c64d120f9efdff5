// Options of render.
#include "tools/vdb_synth/option_makers.h"
#include "tools/vdb_synth/options.h"

namespace vdbsynth::cli {

std::vector<Option> renderOptionTable() {
    std::vector<Option> table{
        option(Kind::Pixels, "size", "WxH")
            .from(16, 8192)
            .measuredIn(Unit::Pixels)
            .says("size of each model's picture, each side")
            .initially("800x600")
            .sets({"size", "width"}),
        option(Kind::Triple, "view", "X,Y,Z")
            .says("direction from the model to the camera")
            .otherwiseIs("1,-1.6,0.9 where z is up, 1,0.9,1.6 where y is"),
        choice("up", "AXIS", {{"y", ""}, {"z", ""}, {"auto", "y for .obj, .gltf and .glb, z for all others"}})
            .says("axis of the model that points up in the picture")
            .initially("auto"),
        option(Kind::Slice, "slice", "z=0.5")
            .sets({"slice", "axis", "fraction"})
            .says(
                "draw a slice across an axis, at a fraction of the domain, with a scale bar in world units, "
                "instead of a shaded picture"),
        whole("turntable", "N", 2, 3600)
            .says(
                "N pictures of the model as it turns once around; #### in -o stands for a picture's number, "
                "from 1"),
        option(Kind::Text, "captions", "TEXTS")
            .says(
                "a caption below each model: texts with commas between them (\\, is a comma), names or none")
            .otherwiseIs("names, the files', of several models; none of one"),
        whole("columns", "N", 1, 64)
            .says("pictures side by side; more models go below")
            .otherwiseIs("all in one row"),
        flag("same-scale").says("draw several models at one scale; without it each fills its picture"),
        option(Kind::Text, "background", "KIND")
            .says("studio (a soft grey), transparent, white, grey, black, or a colour such as #203040")
            .initially("studio"),
        flag("no-ground").says("draw no ground with the model's shadow").sets({"ground"}),
        flag("wireframe")
            .says("draw the edges of faces: a mesh's own, of other models those of the zero level")
            .sets({"wires", "wireframe"}),
        option(Kind::Text, "color", "NAME")
            .says("grid or attribute of the colours, or none")
            .otherwiseIs("Cd, color, colour or rgb, if there is one")
            .sets({"colours", "color"}),
        real("density", "S", 1e-6, 1e6)
            .says("of fog: factor on how much light it absorbs")
            .initially("1")
            .noting("a fog volume is drawn as fog unless --iso is given"),
        whole("samples", "N", 1, 64).says("rays per pixel at edges").initially("4"),
        option(Kind::Grid, "directions", "FILE.vdb[:GRID]")
            .says("draw a direction field, such as analogy --write-directions writes, as streaks on the "
                  "surface"),
        output("output", "FILE", {"png", "html", "htm"})
            .shortly('o')
            .says("picture to write; an .html is a page that shows the models in a browser, to turn and cut"),
    };
    for (Option& option : table) option.takenBy({"render"});
    return table;
}

}  // namespace vdbsynth::cli
