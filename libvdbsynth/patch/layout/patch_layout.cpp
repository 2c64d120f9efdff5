#include "libvdbsynth/patch/layout/patch_layout.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/patch/layout/patch_cut.h"
#include "libvdbsynth/patch/layout/patch_layout_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kChoice = 0x63686f69;
constexpr int kProbes = 12;
constexpr double kGood = 2;  // times the cost of a good match

}  // namespace

PatchLayer::PatchLayer(const PatchField& exemplar, const LayoutOptions& options,
                       PatchArrangement& arrangement, const RunContext& ctx)
    : mExemplar(exemplar), mOptions(options), mArrangement(arrangement), mContext(ctx) {
    mGood = kGood * nearMatchLevel(exemplar, options.patch, options.overlap, kProbes, options.overlap, ctx,
                                   options.barred);
}

PatchOverlap PatchLayer::overlapAt(const PatchPlace& at, int nx, int ny, int rim) const {
    PatchOverlap overlap;
    overlap.nx = nx;
    overlap.ny = ny;
    const std::size_t length = mExemplar.columnLength();
    for (int i = 0; i < nx; ++i)
        for (int j = 0; j < ny; ++j) {
            const bool inRim = i < rim || j < rim || i >= nx - rim || j >= ny - rim;
            const std::ptrdiff_t column = mArrangement.columnAt(at.i + i, at.j + j);
            if (column < 0 || !mArrangement.known(column)) continue;
            if (!inRim && !mArrangement.isFixed(column)) continue;
            overlap.columns.push_back({i, j});
            overlap.values.resize(overlap.values.size() + length);
            readColumn(mExemplar, mArrangement, at.i + i, at.j + j,
                       overlap.values.data() + overlap.values.size() - length);
        }
    return overlap;
}

// Where patches that lie at the overlap would continue.
std::vector<PatchPlace> PatchLayer::continuations(const PatchPlace& at, const PatchOverlap& overlap) const {
    std::vector<std::int32_t> numbers;
    for (const auto& column : overlap.columns) {
        const std::ptrdiff_t sheet = mArrangement.columnAt(at.i + column.i, at.j + column.j);
        const std::int32_t* labels = mArrangement.label.data() + sheet * mArrangement.lattice.nz;
        numbers.insert(numbers.end(), labels, labels + mArrangement.lattice.nz);
        std::sort(numbers.begin(), numbers.end());
        numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    }
    std::vector<PatchPlace> places;
    for (const std::int32_t number : numbers) {
        const LaidPatch& patch = mArrangement.patches[std::size_t(number)];
        PatchPlace place{at.i - patch.at.i, at.j - patch.at.j};
        if (mArrangement.tile) {
            const int nx = mArrangement.lattice.nx, ny = mArrangement.lattice.ny;
            if (place.i > nx / 2) place.i -= nx;
            if (place.i < -(nx / 2)) place.i += nx;
            if (place.j > ny / 2) place.j -= ny;
            if (place.j < -(ny / 2)) place.j += ny;
        }
        places.push_back({place.i + patch.from.i, place.j + patch.from.j});
    }
    return places;
}

PatchCandidate PatchLayer::choose(const PatchPlace& at, const PatchOverlap& overlap) const {
    Random random(mContext.seed, mArrangement.patches.size(), kChoice);
    if (overlap.columns.empty() && !mOptions.barred) {
        const auto rows = std::uint32_t(mExemplar.lattice.nx - overlap.nx + 1),
                   across = std::uint32_t(mExemplar.lattice.ny - overlap.ny + 1);
        const int i = int(random.below(rows)), j = int(random.below(across));
        return {{i, j}, 0};
    }
    CandidateOptions options{mOptions.tolerance, continuations(at, overlap), mOptions.overlap,
                             mOptions.barred};
    auto candidates = patchCandidates(mExemplar, overlap, options, mContext);
    const double values = double(overlap.values.size());
    const auto least = [&] {
        double cost = std::numeric_limits<double>::infinity();
        for (const PatchCandidate& candidate : candidates) cost = std::min(cost, candidate.cost);
        return cost;
    };
    if (candidates.empty() || !(least() <= mGood * values)) {
        options.excluded.clear();
        candidates = patchCandidates(mExemplar, overlap, options, mContext);
    }
    if (candidates.empty())
        throw Error(ErrorCode::Unusable,
                    "no place of the exemplar holds a whole patch beside the hole; a smaller `patch` fits");
    PatchCandidate chosen = candidates[random.below(std::uint32_t(candidates.size()))];
    chosen.cost /= std::max(1.0, values);
    return chosen;
}

// The move t that makes sum (D_old - (D_new - g . t))^2 least, over nodes where both know a surface near;
// Gauss-Newton's first step.
Vec3d PatchLayer::fineMove(const PatchPlace& from, const PatchOverlap& overlap) const {
    constexpr float kNear = 2;
    double xx = 1e-3, xy = 0, yy = 1e-3, x = 0, y = 0;
    for (std::size_t c = 0; c < overlap.columns.size(); ++c) {
        const float* old = overlap.values.data() + c * mExemplar.columnLength();
        const float* now = mExemplar.column(from.i + overlap.columns[c].i, from.j + overlap.columns[c].j);
        for (int k = 0; k < mExemplar.lattice.nz; ++k, old += kFieldValues, now += kFieldValues) {
            if (std::abs(old[0]) > kNear || std::abs(now[0]) > kNear) continue;
            const double gx = double(now[1]), gy = double(now[2]), apart = double(now[0] - old[0]);
            xx += gx * gx;
            xy += gx * gy;
            yy += gy * gy;
            x += gx * apart;
            y += gy * apart;
        }
    }
    const double determinant = xx * yy - xy * xy;
    const Vec3d move{(yy * x - xy * y) / determinant, (xx * y - xy * x) / determinant, 0};
    return {std::clamp(move.x, -1.0, 1.0), std::clamp(move.y, -1.0, 1.0), 0};
}

std::int32_t PatchLayer::lay(const PatchPlace& at, int nx, int ny, int rim, int core) {
    const PatchOverlap overlap = overlapAt(at, nx, ny, rim);
    const PatchCandidate chosen = choose(at, overlap);
    const auto number = std::int32_t(mArrangement.patches.size());
    mArrangement.patches.push_back({chosen.place, at, nx, ny, fineMove(chosen.place, overlap), chosen.cost});
    cutIntoSheet(mExemplar, number, core, mArrangement);
    return number;
}

namespace {

// First columns of the patches along one side, evenly spread.
std::vector<int> starts(int side, int patch, int overlap, bool tile) {
    const int pitch = patch - overlap;
    std::vector<int> at;
    if (tile) {
        const int count = std::max(2, (side + pitch - 1) / pitch);
        for (int n = 0; n < count; ++n) at.push_back(int(std::int64_t(n) * side / count));
        return at;
    }
    if (side <= patch) return {0};
    const int count = 1 + (side - patch + pitch - 1) / pitch;
    for (int n = 0; n < count; ++n) at.push_back(int(std::int64_t(n) * (side - patch) / (count - 1)));
    return at;
}

void requireLayout(const PatchField& exemplar, int nx, int ny, const LayoutOptions& options) {
    const auto require = [](bool holds, const char* text) {
        if (!holds) throw Error(ErrorCode::InvalidOption, text);
    };
    require(nx >= 1 && ny >= 1, "the sheet is smaller than a step of the exemplar's field");
    require(options.patch >= 2 && options.overlap >= 1 && options.overlap < options.patch,
            "a patch must be at least two steps of the field wide and wider than its overlap");
    require(options.tolerance >= 0 && options.tolerance <= 10, "`tolerance` must be 0..10");
    require(options.repairs >= 0 && options.repairs <= 20, "`repairs` must be 0..20");
    require(!options.tile || (3 * nx >= 4 * options.patch && 3 * ny >= 4 * options.patch),
            "to tile, a sheet must be at least 4/3 of a patch wide; a larger `size` or a smaller `patch` is");
    if (options.patch > std::min(exemplar.lattice.nx, exemplar.lattice.ny))
        throw Error(ErrorCode::Unusable, "a patch is larger than the exemplar; a smaller `patch` fits");
}

}  // namespace

PatchArrangement layPatches(const PatchField& exemplar, int nx, int ny, const LayoutOptions& options,
                            const RunContext& ctx) {
    requireLayout(exemplar, nx, ny, options);
    PatchArrangement arrangement;
    arrangement.lattice = {exemplar.lattice.step, nx, ny, exemplar.lattice.nz};
    arrangement.overlap = options.overlap;
    arrangement.tile = options.tile;
    requireMemory(ctx, 4.0 * double(arrangement.lattice.nodes()), "the sheet's map",
                  "a smaller `size` needs less");
    arrangement.label.assign(arrangement.lattice.nodes(), PatchArrangement::kNone);
    PatchLayer layer(exemplar, options, arrangement, ctx);
    const std::vector<int> across = starts(nx, options.patch, options.overlap, options.tile),
                           along = starts(ny, options.patch, options.overlap, options.tile);
    Stage stage(ctx, "laying patches", across.size() * along.size());
    for (const int i : across)
        for (const int j : along) {
            const int width = options.tile ? options.patch : std::min(options.patch, nx - i),
                      depth = options.tile ? options.patch : std::min(options.patch, ny - j);
            layer.lay({i, j}, width, depth, options.patch, -1);
            stage.advance();
        }
    for (int round = 0; round < options.repairs; ++round)
        if (layer.repair() == 0) break;
    return arrangement;
}

}  // namespace vdbsynth
