#include "libvdbsynth/pipeline/direction/place_directions.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/math/pca.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace vdbsynth {
namespace {

using Kind = DirectionSource::Kind;

constexpr std::size_t kMixed = 8;   // nearest strokes
constexpr double kOpposite = 1e-3;  // [radians] from half a turn, where no axis is told from another
constexpr std::size_t kChunk = 4096;

Vec3d unitOrZero(const Vec3d& v) {
    const double size = length(v);
    return std::isfinite(size) && size > 0 ? v * (1 / size) : Vec3d{0, 0, 0};
}

// Strokes mixed at positions anywhere between them.
class MixedStrokes {
public:
    explicit MixedStrokes(const std::vector<Stroke>& strokes) : mOrigin(strokes.front().position) {
        for (const Stroke& stroke : strokes) {
            mPlace.push_back(cast<float>(stroke.position - mOrigin));
            mDirection.push_back(unitOrZero(stroke.direction));
        }
        mNeighbours = std::make_unique<PointNeighbours>(mPlace);
    }
    Vec3d operator()(const Vec3d& world) const {
        std::array<std::uint32_t, kMixed + 1> number;
        std::array<float, kMixed + 1> squared;
        const std::size_t found =
            mNeighbours->nearest(cast<float>(world - mOrigin), kMixed + 1, number.data(), squared.data());
        if (squared[0] == 0) return mDirection[number[0]];
        const bool more = found > kMixed;
        const double least = more ? 1 / std::sqrt(double(squared[kMixed])) : 0;
        Vec3d sum;
        for (std::size_t k = 0; k < std::min(found, kMixed); ++k) {
            const double near = 1 / std::sqrt(double(squared[k])) - least;
            sum = sum + mDirection[number[k]] * (near * near);
        }
        // All nine as far: none counts more than another.
        return dot(sum, sum) > 0 ? sum : mDirection[number[0]];
    }

private:
    Vec3d mOrigin;
    std::vector<Vec3f> mPlace;
    std::vector<Vec3d> mDirection;
    std::unique_ptr<PointNeighbours> mNeighbours;
};

// Across `from`, nearest to z, else to x.
Vec3d anyAcross(const Vec3d& from) {
    for (const Vec3d& axis : {Vec3d{0, 0, 1}, Vec3d{1, 0, 0}}) {
        const Vec3d across = axis - from * dot(axis, from);
        if (length(across) > 0.1) return normalized(across);
    }
    return {1, 0, 0};
}

}  // namespace

std::vector<Vec3d> directionsInSpace(const DirectionSource& source, const std::vector<Vec3d>& positions,
                                     const Vec3d& middle, const std::string& field, const RunContext& ctx) {
    requireOption(
        source.kind != Kind::Automatic, field, "curvature",
        "an axis, around an axis, radial, a grid or strokes: a surface has curvature, space has not");
    std::vector<Vec3d> directions(positions.size());
    std::unique_ptr<MixedStrokes> strokes;
    if (source.kind == Kind::Strokes)
        strokes = std::make_unique<MixedStrokes>(source.strokes);
    else
        directionReader(source, middle, field);  // a grid of a wrong kind is refused here, not in a worker
    parallelFor(ctx, positions.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        const auto reader =
            strokes ? std::function<Vec3d(const Vec3d&)>([&](const Vec3d& p) { return (*strokes)(p); })
                    : directionReader(source, middle, field);
        for (std::size_t i = begin; i < end; ++i) directions[i] = unitOrZero(reader(positions[i]));
    });
    if (std::none_of(directions.begin(), directions.end(), [](const Vec3d& d) { return dot(d, d) > 0; }))
        throw Error(
            ErrorCode::Unusable,
            "`" + field + "`: gives no direction anywhere in the result; check that it lies there (world)");
    return directions;
}

std::vector<Vec3d> rotationsBetween(const std::vector<Vec3d>& from, const std::vector<Vec3d>& directions) {
    PointSums axes;
    for (std::size_t i = 0; i < directions.size(); ++i) axes.add(cross(from[i], directions[i]));
    const Vec3d shared = pointAxes(axes, false).axis[2];
    const bool any = axes.xx + axes.yy + axes.zz > 1e-12;
    std::vector<Vec3d> rotations(directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const Vec3d axis = cross(from[i], directions[i]);
        const double sine = length(axis), cosine = dot(from[i], directions[i]);
        if (cosine < 0 && sine < kOpposite) {
            const Vec3d across = shared - from[i] * dot(shared, from[i]);
            rotations[i] = (any && length(across) > 0.1 ? normalized(across) : anyAcross(from[i])) * kPi;
        } else if (sine > 0) {
            rotations[i] = axis * (arcTangent(sine, cosine) / sine);
        }
    }
    return rotations;
}

}  // namespace vdbsynth
