#include "libvdbsynth/patch/layout/patch_hole_layout.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/patch/layout/patch_layout_steps.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace vdbsynth {
namespace {

struct Columns {
    int i0 = 0, j0 = 0, i1 = 0, j1 = 0;  // both inclusive
};

// The boxes of the connected parts of a hole.
class HoleParts {
public:
    HoleParts(std::vector<std::uint8_t> hole, int nx, int ny) : mHole(std::move(hole)), mNx(nx), mNy(ny) {}

    std::vector<Columns> boxes() {
        std::vector<Columns> found;
        for (int i = 0; i < mNx; ++i)
            for (int j = 0; j < mNy; ++j)
                if (take(i, j)) found.push_back(flood(i, j));
        return found;
    }

private:
    bool take(int i, int j) {
        if (i < 0 || j < 0 || i >= mNx || j >= mNy) return false;
        return std::exchange(mHole[std::size_t(i) * std::size_t(mNy) + std::size_t(j)], std::uint8_t(0)) != 0;
    }

    Columns flood(int i, int j) {
        Columns box{i, j, i, j};
        std::vector<PatchPlace> open{{i, j}};
        while (!open.empty()) {
            const PatchPlace at = open.back();
            open.pop_back();
            box = {std::min(box.i0, at.i), std::min(box.j0, at.j), std::max(box.i1, at.i),
                   std::max(box.j1, at.j)};
            for (int di = -1; di <= 1; ++di)
                for (int dj = -1; dj <= 1; ++dj)
                    if (take(at.i + di, at.j + dj)) open.push_back({at.i + di, at.j + dj});
        }
        return box;
    }

    std::vector<std::uint8_t> mHole;
    int mNx, mNy;
};

// First columns of the patches over low..high and the overlap on both sides, within the sheet.
std::vector<int> startsOver(int low, int high, int side, const LayoutOptions& options) {
    const int span = high - low + 1 + 2 * options.overlap, pitch = options.patch - options.overlap;
    const auto within = [&](int at) { return std::clamp(at, 0, side - options.patch); };
    if (span <= options.patch) return {within((low + high + 1) / 2 - options.patch / 2)};
    const int count = 1 + (span - options.patch + pitch - 1) / pitch;
    std::vector<int> at;
    for (int n = 0; n < count; ++n)
        at.push_back(
            within(low - options.overlap + int(std::int64_t(n) * (span - options.patch) / (count - 1))));
    return at;
}

int knownColumns(const PatchArrangement& sheet, const PatchPlace& at, int side) {
    int known = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) known += sheet.known(sheet.columnAt(at.i + i, at.j + j)) ? 1 : 0;
    return known;
}

// Where patches go, those that touch most of what stays first.
std::vector<PatchPlace> placesOver(const std::vector<Columns>& parts, const PatchArrangement& sheet,
                                   const LayoutOptions& options) {
    std::vector<std::pair<int, PatchPlace>> places;
    for (const Columns& part : parts)
        for (const int i : startsOver(part.i0, part.i1, sheet.lattice.nx, options))
            for (const int j : startsOver(part.j0, part.j1, sheet.lattice.ny, options))
                places.push_back({knownColumns(sheet, {i, j}, options.patch), {i, j}});
    std::stable_sort(places.begin(), places.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<PatchPlace> ordered;
    for (const auto& place : places) ordered.push_back(place.second);
    return ordered;
}

void requireHole(const PatchField& exemplar, int nx, int ny, const std::vector<std::uint8_t>& hole,
                 const LayoutOptions& options) {
    const PatchLattice& l = exemplar.lattice;
    if (nx < 1 || ny < 1 || nx > l.nx || ny > l.ny || hole.size() != std::size_t(nx) * std::size_t(ny))
        throw Error(ErrorCode::ShapeMismatch, "the hole, the sheet and the exemplar differ in size");
    if (options.patch < 2 || options.overlap < 1 || options.overlap >= options.patch || options.tile ||
        !options.barred)
        throw Error(ErrorCode::InvalidOption,
                    "a hole's patch must be wider than its overlap, and barred "
                    "columns given; it cannot tile");
    if (options.patch > std::min(nx, ny))
        throw Error(ErrorCode::Unusable, "a patch is larger than the sheet; a smaller `patch` fits");
    const auto marked = std::size_t(std::count_if(hole.begin(), hole.end(), [](auto h) { return h != 0; }));
    if (marked == 0) throw Error(ErrorCode::Unusable, "the hole has no column of the sheet");
    if (marked == hole.size())
        throw Error(ErrorCode::Unusable, "the hole covers the whole sheet; nothing is left to continue");
}

}  // namespace

std::vector<std::uint8_t> widenedColumns(const std::vector<std::uint8_t>& columns, int nx, int ny,
                                         int reach) {
    // Along one axis, then along the other.
    std::vector<std::uint8_t> across(columns.size(), 0), wide(columns.size(), 0);
    const auto spread = [reach](const std::vector<std::uint8_t>& from, std::vector<std::uint8_t>& to,
                                std::size_t begin, std::size_t stride, int count) {
        for (int at = 0; at < count; ++at) {
            if (!from[begin + std::size_t(at) * stride]) continue;
            for (int n = std::max(0, at - reach); n <= std::min(count - 1, at + reach); ++n)
                to[begin + std::size_t(n) * stride] = 1;
        }
    };
    for (int i = 0; i < nx; ++i) spread(columns, across, std::size_t(i) * std::size_t(ny), 1, ny);
    for (int j = 0; j < ny; ++j) spread(across, wide, std::size_t(j), std::size_t(ny), nx);
    return wide;
}

PatchArrangement layIntoHole(const PatchField& exemplar, int nx, int ny,
                             const std::vector<std::uint8_t>& hole, const LayoutOptions& options,
                             const RunContext& ctx) {
    requireHole(exemplar, nx, ny, hole, options);
    PatchArrangement sheet;
    sheet.lattice = {exemplar.lattice.step, nx, ny, exemplar.lattice.nz};
    sheet.overlap = options.overlap;
    requireMemory(ctx, 4.0 * double(sheet.lattice.nodes()), "the sheet's map", "a smaller SHEET needs less");
    sheet.patches.push_back({{0, 0}, {0, 0}, nx, ny, {}, 0});
    const std::size_t nz = std::size_t(sheet.lattice.nz);
    sheet.label.assign(sheet.lattice.nodes(), 0);
    for (std::size_t c = 0; c < hole.size(); ++c)
        if (hole[c]) std::fill_n(sheet.label.begin() + std::ptrdiff_t(c * nz), nz, PatchArrangement::kNone);
    sheet.fixed = widenedColumns(hole, nx, ny, options.overlap);
    for (std::uint8_t& fixed : sheet.fixed) fixed = fixed ? 0 : 1;
    PatchLayer layer(exemplar, options, sheet, ctx);
    const int side = options.patch;
    const std::vector<PatchPlace> places = placesOver(HoleParts(hole, nx, ny).boxes(), sheet, options);
    Stage stage(ctx, "laying patches", places.size());
    for (const PatchPlace& at : places) {
        if (knownColumns(sheet, at, side) < side * side) layer.lay(at, side, side, side, -1);
        stage.advance();
    }
    for (int round = 0; round < options.repairs; ++round)
        if (layer.repair() == 0) break;
    return sheet;
}

}  // namespace vdbsynth
