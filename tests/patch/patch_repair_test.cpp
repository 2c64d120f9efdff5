#include "libvdbsynth/patch/patch_repair.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/patch/layout/patch_hole_layout.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>

using namespace vdbsynth;

namespace {

constexpr int kSide = 96;

// An egg-crate whose box is all of it; without the points of [low, high)^2 if so.
PatchExemplar crateSheet(const test::EggCrate& crate, double low = 0, double high = 0) {
    const test::PointShape all = test::eggCratePoints(crate, kSide, 0);
    test::PointShape rest;
    for (std::size_t p = 0; p < all.point.size(); ++p) {
        const Vec3f& at = all.point[p];
        if (at.x >= low && at.x < high && at.y >= low && at.y < high) continue;
        rest.point.push_back(at);
        rest.normal.push_back(all.normal[p]);
    }
    return test::exemplarOf(rest, kSide, -crate.height - 2, crate.height + 2);
}

std::vector<std::uint8_t> squareHole(const PatchExemplar& sheet, double low, double high) {
    const PatchLattice l = latticeOf(sheet.size, repairStep(sheet, {}));
    std::vector<std::uint8_t> hole(l.columns(), 0);
    for (int i = 0; i < l.nx; ++i)
        for (int j = 0; j < l.ny; ++j)
            hole[l.column(i, j)] =
                (i + 1) * l.step > low && i * l.step < high && (j + 1) * l.step > low && j * l.step < high;
    return hole;
}

// Heights count from the box's lower side.
double worstOff(const test::EggCrate& crate, const SheetPoints& made) {
    double worst = 0;
    for (const Vec3f& p : made.points) {
        const Vec3d slope = crate.slope(double(p.x), double(p.y));
        worst =
            std::max(worst, std::abs(double(p.z) - crate.height - 2 - crate.at(double(p.x), double(p.y))) /
                                std::sqrt(1 + dot(slope, slope)));
    }
    return worst;
}

bool sameMade(const RepairResult& a, const RepairResult& b) {
    return a.kept == b.kept && a.made.source == b.made.source && a.made.patch == b.made.patch &&
           a.made.points.size() == b.made.points.size() &&
           std::memcmp(a.made.points.data(), b.made.points.data(), a.made.points.size() * sizeof(Vec3f)) == 0;
}

}  // namespace

TEST_CASE("repairPatches: an egg-crate with a hole becomes the formula again") {
    const test::EggCrate crate;
    for (const bool empty : {true, false}) {
        // Within the hole the points that are there count for nothing.
        PatchExemplar sheet = crateSheet(crate, 40, empty ? 56 : 40);
        if (!empty)
            for (std::size_t p = 0; p < sheet.points.size(); ++p) {
                Vec3f& at = sheet.points[p];
                if (at.x >= 40 && at.x < 56 && at.y >= 40 && at.y < 56) at.z = 1;
            }
        const RepairResult repair = repairPatches(sheet, squareHole(sheet, 40, 56), nullptr, {});
        INFO("patch " << repair.patch << " overlap " << repair.overlap);
        CHECK(repair.patches >= 1);
        CHECK((repair.removed > 200) == !empty);
        CHECK(worstOff(crate, repair.made) < 0.3);
        CHECK(double(repair.kept.size() + repair.made.size()) / (kSide * kSide) == Approx(1).margin(0.02));
        // Nothing farther than two overlaps, the blending and two columns is touched.
        const double reach = 2 * repair.overlap + 4 * repair.step;
        std::vector<bool> kept(repair.first, false);
        for (const std::uint32_t number : repair.kept) kept[number] = true;
        for (std::size_t p = 0; p < sheet.points.size(); ++p) {
            const Vec3f& at = sheet.points[p];
            const double x = std::max(40 - double(at.x), double(at.x) - 56),
                         y = std::max(40 - double(at.y), double(at.y) - 56);
            if (std::max(x, y) > reach) REQUIRE(kept[sheet.number[p]]);
        }
        // Copies come from outside of the hole.
        for (std::size_t p = 0; p < repair.made.size(); ++p) {
            const Vec3f& from = sheet.points[repair.made.source[p]];
            REQUIRE_FALSE((from.x >= 40 && from.x < 56 && from.y >= 40 && from.y < 56));
        }
    }
}

TEST_CASE("repairPatches: from another exemplar, at its heights or moved to the sheet's") {
    const test::EggCrate crate;
    const PatchExemplar sheet = crateSheet(crate, 30, 60);
    PatchExemplar other = test::eggCrateExemplar(crate, 48);
    const auto hole = squareHole(sheet, 30, 60);
    const RepairResult repair = repairPatches(sheet, hole, &other, {});
    CHECK(worstOff(crate, repair.made) < 0.3);
    CHECK(std::any_of(repair.made.source.begin(), repair.made.source.end(),
                      [&](std::uint32_t s) { return s >= repair.first; }));
    for (std::size_t p = 0; p < repair.made.size(); ++p)
        REQUIRE((repair.made.source[p] >= repair.first) == (repair.made.patch[p] > 0));
    other.corner = other.corner + Vec3d{7, 8, 100};
    std::string said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { said += text; };
    const RepairResult moved = repairPatches(sheet, hole, &other, {}, ctx);
    CHECK(said.find("moved down") != std::string::npos);
    CHECK(worstOff(crate, moved.made) < 0.4);
}

TEST_CASE("repairPatches: the same for any number of threads, and cancels") {
    const PatchExemplar sheet = crateSheet({}, 40, 56);
    const auto hole = squareHole(sheet, 40, 56);
    CHECK(sameMade(repairPatches(sheet, hole, nullptr, {}, test::onThreads(1)),
                   repairPatches(sheet, hole, nullptr, {}, test::onThreads(4))));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              repairPatches(sheet, hole, nullptr, {}, ctx);
          }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("repairPatches: a hole at the edge, a hole that leaves little, and what is refused") {
    const test::EggCrate crate;
    const PatchExemplar sheet = crateSheet(crate);
    const RepairResult corner = repairPatches(sheet, squareHole(sheet, 0, 14), nullptr, {});
    CHECK(worstOff(crate, corner.made) < 0.5);
    std::string said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { said += text; };
    repairPatches(sheet, squareHole(sheet, 24, 72), nullptr, {}, ctx);
    CHECK(said.find("fits at few places") != std::string::npos);
    const auto with = [&](const std::vector<std::uint8_t>& hole, const PatchOptions& options) {
        return test::thrownBy([&] { repairPatches(sheet, hole, nullptr, options); }).message;
    };
    const auto square = squareHole(sheet, 40, 56);
    CHECK_THAT(with(std::vector<std::uint8_t>(square.size(), 0), {}), Catch::Contains("no column"));
    CHECK_THAT(with(std::vector<std::uint8_t>(square.size(), 1), {}), Catch::Contains("whole sheet"));
    CHECK_THAT(with({1}, {}), Catch::Contains("differ in size"));
    PatchOptions large;
    large.patch = 80;
    CHECK_THAT(with(square, large), Catch::Contains("smaller `patch`"));
}
