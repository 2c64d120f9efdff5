#include "libvdbsynth/pipeline/render/render_options.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

#include <functional>
#include <limits>

using namespace vdbsynth;

namespace {

// What is said of options with one change, of so many models.
std::string refusalOf(const std::function<void(RenderOptions&)>& change, std::size_t models = 1,
                      ErrorCode code = ErrorCode::InvalidOption) {
    RenderOptions options;
    change(options);
    const test::Thrown thrown = test::thrownBy([&] { validate(options, models); });
    CHECK(thrown.code == int(code));
    return thrown.message;
}

GridPtr vectors() {
    openvdb::initialize();
    const auto grid = openvdb::Vec3SGrid::create();
    grid->tree().setValueOn({0, 0, 0}, openvdb::Vec3f(1, 0, 0));
    return grid;
}

}  // namespace

TEST_CASE("validate: a picture's options as they are, and each out of its range", "[pipeline][error]") {
    CHECK_NOTHROW(validate(RenderOptions{}, 3));
    using Options = RenderOptions&;
    CHECK(refusalOf([](Options) {}, 0) == "no model to draw; give at least one");
    CHECK(refusalOf([](Options o) {
              o.size = {8, 64};
          }) == "`size` 8x64: must be from 16 to 8192 pixels each");
    CHECK(test::contains(refusalOf([](Options o) { o.size = {64, 9000}; }), "`size` 64x9000"));
    CHECK(test::contains(refusalOf([](Options o) { o.samples = 65; }), "`samples` 65"));
    for (const double bad : {0.0, -1.0, 1e7, std::numeric_limits<double>::quiet_NaN()})
        CHECK(test::contains(refusalOf([&](Options o) { o.density = bad; }), "`density`"));
    for (const double bad : {0.0, 1e7, std::numeric_limits<double>::quiet_NaN()})
        CHECK(test::contains(refusalOf([&](Options o) {
                                 o.view = Vec3d{bad, 0, 0};
                             }),
                             "must be a direction from the model to the camera"));
    for (const int bad : {1, -1, 3601})
        CHECK(test::contains(refusalOf([&](Options o) { o.turntable = bad; }), "`turntable`"));
    for (const int bad : {0, 65})
        CHECK(test::contains(refusalOf([&](Options o) { o.columns = bad; }), "`columns`"));
    CHECK(refusalOf(
              [](Options o) {
                  o.captions = {"a", "b"};
              },
              3) == "`captions` a,b: has 2 captions for 3 models; give one for each, or none");
    CHECK(test::contains(refusalOf([](Options o) { o.slice = {3, 0.5}; }), "`slice` 3"));
    CHECK(test::contains(refusalOf([](Options o) { o.slice = {0, 1.5}; }), "`slice` 1.5"));
}

TEST_CASE("validate: what cannot be combined", "[pipeline][error]") {
    using Change = std::function<void(RenderOptions&)>;
    const GridPtr along = vectors();
    const std::pair<const char*, Change> all[] = {
        {"directions", [&](RenderOptions& o) { o.directions = along; }},
        {"view",
         [](RenderOptions& o) {
             o.view = Vec3d{1, 0, 0};
         }},
        {"up", [](RenderOptions& o) { o.up = UpAxis::Z; }},
        {"wireframe", [](RenderOptions& o) { o.wireframe = true; }},
        {"turntable", [](RenderOptions& o) { o.turntable = 4; }},
        {"background", [](RenderOptions& o) { o.background.kind = Background::Kind::Plain; }},
        {"ground", [](RenderOptions& o) { o.ground = false; }},
        {"sameScale", [](RenderOptions& o) { o.sameScale = true; }},
        {"color", [](RenderOptions& o) { o.color = "none"; }}};
    for (const auto& [field, change] : all) {
        RenderOptions alone;
        change(alone);
        CHECK_NOTHROW(validate(alone, 1));
        const std::string refusal = refusalOf([&, &set = change](RenderOptions& o) {
            o.slice.emplace();
            set(o);
        });
        CHECK(refusal == std::string("`") + field + "`: cannot be combined with `slice`");
    }
    RenderOptions slice;
    slice.slice.emplace();
    slice.captions = {"a", "b"};
    CHECK_NOTHROW(validate(slice, 2));
    const auto both = [&](RenderOptions& o) {
        o.directions = along;
        o.color = "Cd";
    };
    CHECK(refusalOf(both) == "`directions`: cannot be combined with `color`");
    CHECK(test::contains(refusalOf([&](RenderOptions& o) { o.directions = along; }, 2),
                         "belongs to one model"));
    const auto bools = [](RenderOptions& o) { o.directions = openvdb::BoolGrid::create(); };
    refusalOf(bools, 1, ErrorCode::BadData);
}

TEST_CASE("parseBackground: words and colours", "[pipeline]") {
    Background background;
    CHECK(parseBackground("studio", background));
    CHECK(background.kind == Background::Kind::Studio);
    CHECK(parseBackground("transparent", background));
    CHECK(background.kind == Background::Kind::Transparent);
    for (const auto& [word, grey] :
         {std::pair<const char*, float>{"white", 1.f}, {"grey", 0.5f}, {"black", 0.f}}) {
        CHECK(parseBackground(word, background));
        CHECK(background.kind == Background::Kind::Plain);
        CHECK(background.colour.y == grey);
    }
    CHECK(parseBackground("#20fF00", background));
    CHECK(background.colour.x == float(0x20) / 255);
    CHECK(background.colour.y == 1);
    CHECK(background.colour.z == 0);
    for (const char* word : {"", "blue", "White", "#12345", "#1234567", "#12345g", "123456"})
        CHECK_FALSE(parseBackground(word, background));
}
