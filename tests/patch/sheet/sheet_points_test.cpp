#include "libvdbsynth/patch/sheet/sheet_points.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/patch/sheet/sheet_points_steps.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_sheets.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>

using namespace vdbsynth;

namespace {

const test::Texture& crates() {
    static const test::Texture texture(test::eggCrateExemplar({}, 48), 2);
    return texture;
}

// A plane of 48 x 48, points at random places near those of a lattice.
const test::Texture& plane() {
    static const test::Texture texture(test::exemplarOf(test::eggCratePoints({16, 0}, 48, 8), 48), 2);
    return texture;
}

SheetOptions withReach(double reach, bool blend) {
    SheetOptions options;
    options.reach = reach;
    options.blend = blend;
    return options;
}

bool sameBits(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)) == 0);
}

}  // namespace

TEST_CASE("sheetPoints: one patch gives the exemplar's points, bit for bit") {
    const test::Texture& texture = crates();
    PatchArrangement whole;
    whole.lattice = texture.field.lattice;
    whole.patches = {{{0, 0}, {0, 0}, 24, 24, {}, 0}};
    whole.label.assign(whole.lattice.nodes(), 0);
    const SheetResult made = texture.sheet(whole, withReach(4, true));
    std::vector<std::uint32_t> inside;
    for (std::size_t p = 0; p < texture.exemplar.points.size(); ++p) {
        const Vec3f& at = texture.exemplar.points[p];
        if (at.x >= 0 && at.y >= 0 && at.x < 48 && at.y < 48) inside.push_back(std::uint32_t(p));
    }
    REQUIRE(made.sheet.size() == inside.size());
    std::vector<std::uint32_t> sources = made.sheet.source;
    std::sort(sources.begin(), sources.end());
    CHECK(sources == inside);
    for (std::size_t p = 0; p < made.sheet.size(); ++p) {
        const std::uint32_t source = made.sheet.source[p];
        REQUIRE(std::memcmp(&made.sheet.points[p], &texture.exemplar.points[source], sizeof(Vec3f)) == 0);
        REQUIRE(std::memcmp(&made.sheet.normals[p], &texture.exemplar.normals[source], sizeof(Vec3f)) == 0);
        REQUIRE(made.sheet.patch[p] == 0);
        REQUIRE(made.sheet.blended[p] == 0);
    }
    CHECK(made.borders.warps == 0);
}

TEST_CASE("sheetPoints: patches that continue each other are not warped by over 1e-6 spacings") {
    const test::Texture& texture = crates();
    const SheetResult made = texture.sheet(test::cutInTwo(texture, {}), withReach(4, false));
    CHECK(made.borders.apartBefore < 1e-6);
    CHECK(made.borders.apartAfter < 1e-6);
    CHECK(made.borders.shrunk == 0);
    std::size_t count = 0;
    for (const Vec3f& p : texture.exemplar.points)
        if (p.x >= 0 && p.y >= 0 && p.x < 40 && p.y < 48) ++count;
    CHECK(made.sheet.size() == count);
    for (std::size_t p = 0; p < made.sheet.size(); ++p) {
        const Vec3f& from = texture.exemplar.points[made.sheet.source[p]];
        REQUIRE(length(made.sheet.points[p] - from) < 1e-6f);
        REQUIRE(made.sheet.patch[p] == (from.x < 20 ? 0 : 1));
    }
}

TEST_CASE("sheetPoints: sides apart meet in the middle, and nothing beyond the reach moves") {
    const test::Texture& texture = plane();
    // The right side half a step, a spacing, higher.
    const PatchArrangement sheet = test::cutInTwo(texture, {0, 0, 0.5});
    const SheetResult before = texture.sheet(sheet, withReach(0, false)),
                      after = texture.sheet(sheet, withReach(5, false));
    CHECK(before.borders.warps == 0);
    CHECK(after.borders.warps == 2);
    CHECK(after.borders.shrunk == 0);
    CHECK(after.borders.apartBefore == Approx(1).epsilon(0.01));
    CHECK(after.borders.apartAfter < 0.1);
    REQUIRE(after.sheet.size() == before.sheet.size());
    const double floor = double(texture.exemplar.points[0].z);
    for (std::size_t p = 0; p < after.sheet.size(); ++p) {
        const double off = std::abs(double(before.sheet.points[p].x) - 20);
        const double z = double(after.sheet.points[p].z) - floor,
                     was = double(before.sheet.points[p].z) - floor;
        REQUIRE(was == Approx(after.sheet.patch[p] == 0 ? 0 : 1).margin(1e-5));
        if (off > 2 + 10) REQUIRE(z == was);
        if (off < 1) REQUIRE(z == Approx(0.5).margin(0.1));
        REQUIRE(length(after.sheet.normals[p]) == Approx(1).margin(1e-5));
    }
}

TEST_CASE("sheetPoints: sides farther apart than the limit are left as they are") {
    const test::Texture& texture = plane();
    const PatchArrangement sheet = test::cutInTwo(texture, {0, 0, 0.5});
    SheetOptions options = withReach(5, false);
    options.limit = 0.4;
    const SheetResult left = texture.sheet(sheet, options), as = texture.sheet(sheet, withReach(0, false));
    CHECK(left.borders.warps == 0);
    CHECK(sameBits(left.sheet.points, as.sheet.points));
}

TEST_CASE("sheetPoints: only points at borders are blended, and lie evenly there") {
    const test::Texture& texture = crates();
    // The right half from a period farther on, moved by a third of a step along y.
    PatchArrangement sheet = test::halves(texture, 20, 24, {{0, 0}, {0, 0}, 12, 24, {}, 0},
                                          {{16, 0}, {8, 0}, 8, 24, {0, 0.15, 0}, 0});
    sheet.patches[1].nx = 8;
    for (int i = 16; i < 20; ++i)  // beyond the exemplar's end: nothing
        std::fill_n(sheet.label.begin() + std::ptrdiff_t(sheet.lattice.column(i, 0)) * sheet.lattice.nz,
                    24 * sheet.lattice.nz, PatchArrangement::kNone);
    const SheetResult made = texture.sheet(sheet, withReach(4, true));
    const test::EggCrate crate;
    const PointNeighbours neighbours(made.sheet.points);
    std::size_t blended = 0;
    for (std::size_t p = 0; p < made.sheet.size(); ++p) {
        const Vec3d at = cast<double>(made.sheet.points[p]);
        const bool near = std::abs(at.x - 20) < 6 || std::abs(at.x - 32) < 6;
        if (made.sheet.blended[p]) {
            ++blended;
            REQUIRE(near);
        }
        if (std::abs(at.x - 20) > 8 || at.y < 2 || at.y > 46) continue;
        // Between the two phases.
        const double z = at.z - crate.height - 2, one = crate.at(at.x, at.y),
                     other = crate.at(at.x, at.y - 0.3);
        REQUIRE(z > std::min(one, other) - 0.1);
        REQUIRE(z < std::max(one, other) + 0.1);
        std::uint32_t number[2];
        float squared[2];
        neighbours.nearest(made.sheet.points[p], 2, number, squared);
        REQUIRE(squared[1] > 0.4f * 0.4f);
        REQUIRE(squared[1] < 1.2f * 1.2f);
    }
    CHECK(blended > 100);
    CHECK(made.borders.apartBefore > made.borders.apartAfter);
}

TEST_CASE("sheetPoints: a tile's points lie in its period, each once") {
    const test::Texture& texture = crates();
    // Patches as deep as the tile: what is beside a patch comes round to its other side.
    PatchArrangement tile = test::halves(texture, 16, 16, {{0, 0}, {0, 0}, 10, 16, {}, 0},
                                         {{6, 3}, {6, 0}, 10, 16, {0.3, -0.4, 0}, 0});
    tile.tile = true;
    const SheetResult plain = texture.sheet(tile, withReach(0, false));
    CHECK(double(plain.sheet.size()) == Approx(32 * 32).epsilon(0.03));
    std::vector<std::pair<std::int32_t, std::uint32_t>> copies;
    for (std::size_t p = 0; p < plain.sheet.size(); ++p)
        copies.emplace_back(plain.sheet.patch[p], plain.sheet.source[p]);
    std::sort(copies.begin(), copies.end());
    CHECK(std::unique(copies.begin(), copies.end()) == copies.end());
    const SheetResult made = texture.sheet(tile, withReach(3, true));
    CHECK(double(made.sheet.size()) == Approx(32 * 32).epsilon(0.06));
    for (const Vec3f& p : made.sheet.points) {
        REQUIRE((p.x >= 0 && p.x < 32));
        REQUIRE((p.y >= 0 && p.y < 32));
    }
}

TEST_CASE("sheetPoints: where nothing lies there are no points") {
    const test::Texture& texture = plane();
    PatchArrangement empty;
    empty.lattice = texture.field.lattice;
    empty.label.assign(empty.lattice.nodes(), PatchArrangement::kNone);
    CHECK(texture.sheet(empty, withReach(4, true)).sheet.size() == 0);
    // A patch that got nothing.
    empty.patches = {{{0, 0}, {0, 0}, 4, 4, {}, 0}};
    CHECK(texture.sheet(empty, withReach(4, true)).sheet.size() == 0);
}

TEST_CASE("sheetPoints: what is refused") {
    const test::Texture& texture = plane();
    const PatchArrangement sheet = test::cutInTwo(texture, {});
    const auto code = [&](const SheetOptions& options) {
        return test::thrownBy([&] { texture.sheet(sheet, options); }).code;
    };
    for (const double reach : {-1.0, 65.0, std::nan("")})
        CHECK(code(withReach(reach, false)) == int(ErrorCode::InvalidOption));
    for (const double limit : {0.05, 8.1, std::nan("")}) {
        SheetOptions options;
        options.limit = limit;
        CHECK(code(options) == int(ErrorCode::InvalidOption));
    }
}

TEST_CASE("borderDistance: rings of nodes around each border, as by looking at all") {
    PatchArrangement sheet;
    sheet.lattice = {1, 9, 7, 3};
    for (std::size_t n = 0; n < sheet.lattice.nodes(); ++n) sheet.label.push_back(n == 30 || n == 31 ? 1 : 0);
    for (const bool tile : {false, true}) {
        sheet.tile = tile;
        const auto distance = borderDistance(sheet, 4, {});
        const auto differs = [&](int i, int j, int k, int reach) {
            for (int di = -reach; di <= reach; ++di)
                for (int dj = -reach; dj <= reach; ++dj) {
                    const std::ptrdiff_t column = sheet.columnAt(i + di, j + dj);
                    for (int at = std::max(0, k - reach); column >= 0 && at <= std::min(2, k + reach); ++at)
                        if (sheet.label[std::size_t(column * 3 + at)] !=
                            sheet.label[sheet.lattice.column(i, j) * 3 + std::size_t(k)])
                            return true;
                }
            return false;
        };
        for (int i = 0; i < 9; ++i)
            for (int j = 0; j < 7; ++j)
                for (int k = 0; k < 3; ++k) {
                    int wanted = 0;
                    while (wanted < 4 && !differs(i, j, k, wanted + 1)) ++wanted;
                    REQUIRE(int(distance[sheet.lattice.column(i, j) * 3 + std::size_t(k)]) == wanted);
                }
    }
}

TEST_CASE("sheetPoints: same bits for any number of threads, and cancelled", "[patch][tsan]") {
    const test::Texture& texture = crates();
    const PatchArrangement sheet = test::cutInTwo(texture, {0.3, 0.2, 0.1});
    const SheetResult one = texture.sheet(sheet, withReach(4, true), test::onThreads(1)),
                      three = texture.sheet(sheet, withReach(4, true), test::onThreads(3));
    CHECK(sameBits(one.sheet.points, three.sheet.points));
    CHECK(sameBits(one.sheet.normals, three.sheet.normals));
    CHECK(one.sheet.source == three.sheet.source);
    CHECK(one.borders.apartAfter == three.borders.apartAfter);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              texture.sheet(sheet, withReach(4, true), ctx);
          }).code == int(ErrorCode::Cancelled));
}
