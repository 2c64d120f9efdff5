#include "tools/vdb_synth/option_value.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>

#include "tests/support/comma_locale.h"
#include "tests/support/makers.h"
#include "tools/vdb_synth/options.h"

using namespace vdbsynth;
using namespace vdbsynth::cli;

namespace {

std::string normal(const std::string& command, const std::string& name, const std::string& given) {
    return normalValue(*findOption(command, name), given);
}

std::string refusal(const std::string& command, const std::string& name, const std::string& given) {
    const test::Thrown thrown = test::thrownBy([&] { normal(command, name, given); });
    CHECK(thrown.code == int(ErrorCode::InvalidOption));
    return thrown.message;
}

}  // namespace

TEST_CASE("normalValue: one form however it was typed", "[tools]") {
    CHECK(normal("synth", "block", "16") == "16");
    CHECK(normal("synth", "block", "16.0") == "16");
    CHECK(normal("synth", "block", "+16") == "16");
    CHECK(normal("convert", "resolution", "1e5") == "100000");
    CHECK(normal("convert", "voxel-size", "0.50") == "0.5");
    CHECK(normal("synth", "size", "2.0x,128,1x") == "2x,128,1x");
    CHECK(normal("synth", "size", "100000,128,1x") == "100000,128,1x");
    CHECK(normal("synth", "size", "2.50w,128,1x") == "2.5w,128,1x");
    CHECK(normal("synth", "border", "tile") == "tile,tile,tile");
    CHECK(normal("synth", "border", "cut,object,tile") == "cut,object,tile");
    CHECK(normal("crop", "box", "0,0,0,7,8,9") == "0,0,0,7,8,9");
    CHECK(normal("crop", "box", "0.50w,0,0,1.5w,8,9.0") == "0.5w,0,0,1.5w,8,9");
    CHECK(normal("synth", "hole", "0w,0w,0w,1.50w,1w,1w") == "0w,0w,0w,1.5w,1w,1w");
    CHECK(normal("synth", "origin", "1w,2.50w,-3") == "1,2.5,-3");
    CHECK(normal("synth", "direction", "1,0.50,0") == "1,0.5,0");
    CHECK(normal("make", "size", "64,64,32.0") == "64,64,32");
    CHECK(normal("match", "at", "-5,0,7") == "-5,0,7");
    CHECK(normal("render", "view", "1.0,-1.60,.9") == "1,-1.6,0.9");
    CHECK(normal("render", "size", "0800x600") == "800x600");
    CHECK(normal("render", "slice", "z=0.50") == "z=0.5");
    CHECK(normal("mask", "range", "-1.0,5e-1") == "-1,0.5");
    CHECK(normal("convert", "labels", "1,4.0,10-20,-3--1,0.1") == "1,4,10-20,-3--1,0.1");
    CHECK(normal("compare", "process", "make  balls") == "make balls");
    CHECK(normal("compare", "process", "make balls --feature 12.0") == "make balls --feature 12");
    CHECK(normal("convert", "seed", "18446744073709551615") == "18446744073709551615");
    CHECK(normal("convert", "max-memory", "1.5G") == "1500000000");
    CHECK(normal("convert", "as", "points") == "points");
    CHECK(normal("convert", "pixel-size", "2.0") == "2");
    CHECK(normal("convert", "pixel-size", "1e1,10,30.0") == "10,10,30");
}

TEST_CASE("normalValue: how standard input is read makes no other result", "[tools]") {
    CHECK(normal("convert", "as", "obj") == "auto");
    CHECK(test::contains(refusal("convert", "as", "doc"), "--as doc: must be auto, mesh"));
}

TEST_CASE("normalValue: of a path that is read only the file's name is left", "[tools][property]") {
    CHECK(normal("synth", "keep", "/a/b/c.ply") == "c.ply");
    CHECK(normal("synth", "hole", "../x/hole.vdb") == "hole.vdb");
    CHECK(normal("synth", "hole", "0,0,0,1,1,1") == "0,0,0,1,1,1");
    CHECK(normal("synth", "hole", "auto") == "auto");
    CHECK(normal("synth", "guide", "a/b.vdb:density") == "b.vdb:density");
    CHECK(normal("synth", "exemplar-map", "a/b.ply") == "b.ply");
    CHECK(normal("texture", "region", "auto") == "auto");
    CHECK(normal("texture", "region", "a/b.vdb:part") == "b.vdb:part");
    CHECK(test::contains(refusal("texture", "region", "automatic"),
                         "a model, FILE.vdb:GRID for a grid, or auto"));
    CHECK(pathIn(*findOption("texture", "region"), "auto").empty());
    CHECK(normal("analogy", "direction", "a/s.csv") == "s.csv");
    CHECK(normal("analogy", "direction", "a/s.vdb:v") == "s.vdb:v");
    CHECK(normal("analogy", "direction", "axis:-z") == "axis:-z");
    CHECK(normal("texture", "channel", "rough=/secret/place/a.png") == "rough=a.png");
    CHECK(pathIn(*findOption("texture", "channel"), "rough=/secret/a.png") == "/secret/a.png");
    for (const char* bad : {"a.png", "=a.png", "rough=", "rough=a.vdb", "r h=a.png", "../r=a.png"})
        CHECK(test::contains(refusal("texture", "channel", bad), "NAME=FILE"));
    for (const Option& option : allOptions()) {
        if (!readsPath(option) || option.kind == Kind::NamedImage) continue;
        // Of a kind that the option takes.
        const bool vdb = option.extensions.empty() ||
                         std::count(option.extensions.begin(), option.extensions.end(), "vdb") > 0;
        const std::string name = "a." + (vdb ? std::string("vdb") : option.extensions.front());
        for (const char* folder : {"/secret/place/", "../secret/"}) {
            const std::string path = std::string(folder) + name;
            INFO(option.name);
            CHECK(normalValue(option, path) == name);
            CHECK(pathIn(option, path) == path);
        }
    }
}

TEST_CASE("normalValue: what is out of range or of another kind is refused in one line", "[tools][error]") {
    for (const char* given : {"2.5m,1,1", "1,1,2cm"})
        CHECK(test::contains(refusal("synth", "size", given), "is not read: lengths are in the units"));
    CHECK_FALSE(test::contains(refusal("synth", "size", "2y,1,1"), "is not read"));
    CHECK(refusal("synth", "block", "3") == "--block 3: must be a whole number from 4 to 256");
    for (const char* bad : {"", "x", "4.5", "1e99", "nan", "0x10", "16 ", "257", "9223372036854775808"})
        CHECK(test::contains(refusal("synth", "block", bad), "--block"));
    CHECK(refusal("convert", "voxel-size", "0") == "--voxel-size 0: must be a number above 0");
    CHECK(refusal("convert", "half-width", "1") == "--half-width 1: must be a number from 1.5 to 100");
    for (const char* bad : {"-1", "inf", "1,5", "0,5", "1e400", "1 2"})
        CHECK(test::contains(refusal("convert", "voxel-size", bad), "--voxel-size"));
    CHECK(test::contains(refusal("analogy", "samples", "4"), "an odd number from 3 to 9"));
    CHECK(refusal("analogy", "sweeps", "0") == "--sweeps 0: must be a whole number from 1 to 10");
    for (const char* bad : {"2x,2x", "nanx,2x,2x", "0.5x,1x,1x", "0,1,1", "1.5,1,1", "2x,2x,2x,2x", "2y,1,1",
                            "2000000,1,1", ",,"})
        CHECK(test::contains(refusal("synth", "size", bad), std::string("--size ") + bad));
    for (const char* bad : {"tiles", "cut,cut", "cut,cut,cut,cut", "cut,,cut", ""})
        CHECK(test::contains(refusal("synth", "border", bad), "cut, object or tile"));
    for (const char* bad : {"1,2,3", "0,0,0,1,1,-1", "0m,0,0,1,1,1", "0x,0,0,1x,1,1", "1w,0,0,1w,1,1",
                            "0.5,0,0,1,1,1", "0,0,0,1,1,99999999999", "-2147483648,0,0,1,1,1", "a,0,0,1,1,1"})
        CHECK(test::contains(refusal("crop", "box", bad), "--box"));
    for (const char* bad : {"5-1", "", "1,,2", "a", "1-2-3"})
        CHECK(test::contains(refusal("convert", "labels", bad), "--labels"));
    for (const char* bad : {"q=1", "z=2", "z=", "z", "z=a"})
        CHECK(test::contains(refusal("render", "slice", bad), "z=0.5"));
    for (const char* bad : {"9x9", "800", "800x", "800x9000", "axb"})
        CHECK(test::contains(refusal("render", "size", bad), "WIDTHxHEIGHT"));
    for (const char* bad :
         {"make bread", "bake balls", "make balls --feature 1", "make balls --size 3", "make"})
        CHECK(test::contains(refusal("compare", "process", bad), "from 4 to 256"));
    for (const char* bad : {"xyw", "xx", ""})
        CHECK(test::contains(refusal("compare", "stationary", bad), "--stationary"));
    for (const char* bad : {"1,0", "1", "0,1,2", "a,b"})
        CHECK(test::contains(refusal("mask", "range", bad), "--range"));
    for (const char* bad : {"3", "3K", "G", "-4G", "1e30"})
        CHECK(test::contains(refusal("convert", "max-memory", bad), "at least 1M"));
    for (const char* bad : {"-1", "1.5", "18446744073709551616", ""})
        CHECK(test::contains(refusal("convert", "seed", bad), "--seed"));
    CHECK(test::contains(refusal("match", "at", "1.5,0,0"), "--at"));
    CHECK(test::contains(refusal("match", "at", "1e9,0,0"), "--at"));
}

TEST_CASE("normalValue: files are known by their extensions, before any is read", "[tools][error]") {
    CHECK(test::contains(refusal("synth", "guide", "m.png"),
                         "--guide m.png: must be a .vdb file, or FILE.vdb:GRID"));
    CHECK(test::contains(refusal("synth", "hole", "m.doc"),
                         "a model, a box i,j,k,I,J,K (voxels, or world with a w), or auto"));
    CHECK(test::contains(refusal("analogy", "direction", "axis:w"), "axis:x|y|z"));
    CHECK(test::contains(refusal("compare", "map", "m.obj"), "--map m.obj: must be a .vdb file"));
    CHECK(test::contains(refusal("synth", "keep", "m.doc"), "m.doc: unknown extension"));
    CHECK(test::contains(refusal("render", "output", "x.jpg"), "--output x.jpg: unknown extension"));
    CHECK(test::contains(refusal("match", "output", "x.vdb"), "must be a .json file"));
    CHECK(test::contains(refusal("convert", "output", "x.doc"), "x.doc: unknown extension"));
    CHECK_NOTHROW(normal("convert", "report", "any.txt"));
    CHECK_NOTHROW(normal("convert", "output", "-"));
}

TEST_CASE("normalValue: no locale matters", "[tools]") {
    const test::CommaLocale comma;
    CHECK(normal("convert", "voxel-size", "0.5") == "0.5");
    CHECK(normal("synth", "size", "1.5x,1000000,1x") == "1.5x,1000000,1x");
    CHECK(test::contains(refusal("convert", "half-width", "1"), "from 1.5 to 100"));
    CHECK(normal("crop", "box", "0,0,0,1000,1000,1000") == "0,0,0,1000,1000,1000");
}

TEST_CASE("splitGridPath: a grid's name follows the extension", "[tools]") {
    CHECK(splitGridPath("a/b.vdb:c").file == "a/b.vdb");
    CHECK(splitGridPath("a/b.vdb:c").grid == "c");
    CHECK(splitGridPath("a/b.vdb").grid.empty());
    CHECK(splitGridPath("c:/a.vdb").file == "c:/a.vdb");
    CHECK(namesGrid("a.VDB"));
    CHECK_FALSE(namesGrid("a.ply"));
    CHECK_FALSE(namesGrid(""));
}

TEST_CASE("normalValue: a pixel size is one to three numbers above 0", "[tools][error]") {
    CHECK(normal("convert", "pixel-size", "2,3") == "2,3");
    for (const char* value : {"", "0", "1,0", "1,2,3,4", "1,,2", "a", "1,-1", "1,2,", "nan", "1,1e31"})
        CHECK(test::contains(refusal("convert", "pixel-size", value),
                             "one to three numbers above 0, with commas"));
}

TEST_CASE("normalValue: a hole is a box of voxels, or of the world for patch, or a model", "[tools][error]") {
    CHECK(normal("patch", "hole", "1.50,2,-3,4,5,6e0") == "1.5,2,-3,4,5,6");
    CHECK(normal("patch", "hole", "some/hole.obj") == "hole.obj");
    for (const char* value : {"auto", "1,2,3,4,5", "1,2,3,4,5,3", "4,2,3,1,5,6", "1,2,3,4,5,nan", "x"})
        CHECK(test::contains(refusal("patch", "hole", value), "must be a model, or a box x,y,z,X,Y,Z"));
    CHECK(normal("synth", "hole", "auto") == "auto");
    CHECK(test::contains(refusal("synth", "hole", "1.5,2,3,4,5,6"), "must be a model, a box i,j,k,I,J,K"));
}
