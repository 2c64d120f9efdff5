// Options of texture.
#include "tools/vdb_synth/option_makers.h"
#include "tools/vdb_synth/options.h"

namespace vdbsynth::cli {
namespace {

const std::vector<std::string> kTexture{"texture"}, kWithRepeat{"texture", "repeat"},
    kWithRelief{"texture", "relief"};

std::vector<Option> methodTable() {
    return {
        choice("method", "NAME",
               {{"default", "coordinates corrected coarse to fine"},
                {"parameterize", "the paper's patches"},
                {"match", "the paper's neighbourhood matching"},
                {"hybrid", "both, as published in 2004"}})
            .says("how to texture")
            .initially("default")
            .takenBy(kTexture),
        whole("levels", "N", 1, 12)
            .says("levels, coarse to fine")
            .otherwiseIs("as many as the sample's size asks for")
            .takenBy(kWithRelief),
        whole("passes", "N", 0, 20)
            .says("passes of correction on every level, of --method default")
            .initially("2")
            .takenBy(kWithRelief),
        real("coherence", "K", 0, 10)
            .says("preference for continuing a neighbour over the nearest match, of --method default")
            .initially("2")
            .takenBy(kWithRelief),
        whole("neighbours", "K", 4, 128)
            .says("neighbours of a point, of --method parameterize, match and hybrid")
            .initially("25")
            .takenBy(kTexture),
        flag("coherent")
            .says("try only what continues neighbours, of --method match (faster)")
            .takenBy(kTexture),
        whole("match-sample", "N", 4, 1 << 20)
            .measuredIn(Unit::Pixels)
            .says("side of the part of the image that --method hybrid matches in")
            .otherwiseIs("the whole image")
            .takenBy(kTexture),
        real("uniformity", "U", 0, 10)
            .says("preference for places of the image that are used less, of --method default")
            .initially("0.25")
            .takenBy(kWithRelief),
        real("histogram", "H", 0, 10)
            .says("preference for values that are rarer than in the image, of --method default")
            .initially("0.75")
            .takenBy(kWithRelief),
        real("max-rotation", "DEGREES", 0, 180)
            .says("how far pieces of the image may be rotated from the smooth field, of --method default "
                  "without "
                  "--direction")
            .initially("60")
            .takenBy(kWithRelief),
        choice("blend", "HOW",
               {{"off", ""},
                {"auto", "histogram for images without structure"},
                {"weight", "as published"},
                {"histogram", "keeps contrast"}})
            .says("mixing of colours where pieces of the image meet, of --method default and parameterize")
            .initially("auto")
            .takenBy(kTexture),
        flag("draft")
            .says("a quick look: no passes of correction but on the coarsest level, nothing mixed")
            .takenBy(kWithRelief),
    };
}

std::vector<Option> controlTable() {
    return {
        real("scale", "S", 0.01, 100)
            .says("size of the texture; at 1 a pixel is as wide as points are apart")
            .initially("1")
            .takenBy(kTexture),
        choice("tile", "WHEN", {{"auto", "where its opposite borders match"}, {"yes", ""}, {"no", ""}})
            .says("whether an image continues at its opposite border")
            .initially("auto")
            .sets({"tileable", "tile"})
            .takenBy(kWithRelief),
        option(Kind::NamedImage, "channel", "NAME=FILE")
            .says("a further map of the image, of the same size: roughness, normal, height ...; synthesized "
                  "with it and written by this name")
            .noting("of several images once for each, in their order")
            .repeatable()
            .takenBy(kWithRepeat)
            .butFor("repeat",
                    [](Option& o) {
                        o.says("of a texture: a further map of the image, of the same size").noting("");
                    }),
        option(Kind::Region, "region", "WHERE")
            .says(
                "of several images, where each goes: auto divides the target by creases, curvature and gaps "
                "(the largest region gets the first), FILE.vdb:GRID is a grid of numbers from 0, of two "
                "images also of truths or of weights (above 0.5: the second), a MODEL has the second of two "
                "inside")
            .takenBy(kWithRelief),
        option(Kind::Text, "region-attribute", "NAME")
            .says("of several images: an attribute of the target's points that numbers the image for each, "
                  "from 0")
            .takenBy(kTexture),
        real("region-blend", "W", 0, 1000)
            .measuredIn(Unit::Pixels)
            .says("of several images: how far from borders between them colours cross-fade")
            .initially("0")
            .takenBy(kTexture),
        option(Kind::Text, "displace", "NAME")
            .says("a map from --channel that moves the points along their normals")
            .takenBy(kTexture),
        real("amplitude", "A")
            .measuredIn(Unit::World)
            .says("with --displace: by how much where the map is white")
            .takenBy(kTexture),
    };
}

}  // namespace

std::vector<Option> textureOptionTable() {
    std::vector<Option> table;
    for (Option& option : methodTable()) table.push_back(option.in(Group::Method));
    for (Option& option : controlTable()) table.push_back(option.in(Group::Controls));
    return table;
}

}  // namespace vdbsynth::cli
