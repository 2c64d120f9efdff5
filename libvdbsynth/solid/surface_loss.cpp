#include "libvdbsynth/solid/surface_loss.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/winding_number.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kNear = 1.5f;          // [voxels^2] from a crossing
constexpr double kMostSamples = 4e6;   // of all faces, besides one for each
constexpr std::size_t kProbes = 4096;  // places that tell the share of the outer surface
constexpr double kSideStep = 0.01;     // [voxels] off a face, to see its sides

// The least squared distance from a place to the crossings of the lattice's edges with the zero level, of
// those within the box of samples around it.
// @param values  [side^3] samples from `corner` on, x slowest
float nearestCrossing(const Vec3f& p, const Index3& corner, const float* values, int side) {
    float nearest = 1e9f;
    const int stride[3] = {side * side, side, 1};
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            for (int z = 0; z < side; ++z) {
                const int at = (x * side + y) * side + z;
                const int place[3] = {x, y, z};
                for (int axis = 0; axis < 3; ++axis) {
                    if (place[axis] + 1 >= side) continue;
                    const float a = values[at], b = values[at + stride[axis]];
                    if ((a < 0) == (b < 0)) continue;
                    Vec3f crossing{float(corner.x + x), float(corner.y + y), float(corner.z + z)};
                    crossing[axis] += a / (a - b);
                    const Vec3f offset = crossing - p;
                    nearest = std::min(nearest, dot(offset, offset));
                }
            }
    return nearest;
}

// True if the zero level passes within `reach` of a place, at least about a voxel.
bool isNear(const BrickField& field, const Vec3f& p, float reach) {
    const Index3 base{int(std::floor(p.x)), int(std::floor(p.y)), int(std::floor(p.z))};
    float values[216];
    const float limit = std::max(kNear, (reach + 0.25f) * (reach + 0.25f));
    for (const int side : {2, 4, 6}) {
        if (side == 6 && limit <= kNear) return false;
        const Index3 corner = base - Index3{side / 2 - 1, side / 2 - 1, side / 2 - 1};
        field.readBox(corner, {side, side, side}, values);
        if (nearestCrossing(p, corner, values, side) <= limit) return true;
    }
    return false;
}

struct Lost {
    Vec3d place, normal;  // [voxels]; of length 1
    double area;
    std::uint32_t face;
};

struct Face {
    Vec3d corner, u, v, normal;
    double area;
};

Face faceOf(const Mesh& mesh, const Triangle& t) {
    Face face;
    face.corner = cast<double>(mesh.points[t[0]]);
    face.u = cast<double>(mesh.points[t[1]]) - face.corner;
    face.v = cast<double>(mesh.points[t[2]]) - face.corner;
    const Vec3d across = cross(face.u, face.v);
    face.area = length(across) / 2;
    face.normal = normalized(across);
    return face;
}

// Place i of n that cover a triangle evenly: the additive recurrence of the plastic number [roberts2018],
// folded into it; the middle for one.
Vec3d placeOn(const Face& face, std::size_t i, std::size_t n) {
    double s = 1.0 / 3, t = 1.0 / 3;
    if (n > 1) {
        s = std::fmod(0.5 + 0.7548776662466927 * double(i + 1), 1.0);
        t = std::fmod(0.5 + 0.5698402909980532 * double(i + 1), 1.0);
        if (s + t > 1) {
            s = 1 - s;
            t = 1 - t;
        }
    }
    return face.corner + face.u * s + face.v * t;
}

class Comparison {
public:
    Comparison(const Mesh& mesh, const BrickField& result, const RunContext& ctx)
        : mMesh(mesh), mTriangles(triangulated(mesh)), mResult(result), mContext(ctx) {
        const MeshSummary summary = summarize(mesh);
        mArea = summary.area;
        if (summary.openEdges == 0) mVolume = summary.signedVolume;
    }

    SurfaceLoss run() {
        findLost();
        SurfaceLoss loss;
        loss.outerArea = mArea;
        const double solid = mVolume > 0 ? enclosedVolume(mResult, mContext) : 0;
        const bool shrunk = mVolume > 0 && solid < 0.9 * mVolume;
        mParts = meshParts(mMesh, mContext);
        findVanished();
        const bool vanished = std::find(mVanished.begin(), mVanished.end(), 1) != mVanished.end();
        if (mLost.empty() && !shrunk && !vanished) return loss;
        const WindingNumber winding(mMesh, mContext);
        const double outer = outerShare(winding);
        loss.outerArea = mArea * outer;
        if (shrunk && outer > 0.999) loss.volumeLeft = solid / mVolume;
        dropInner(winding);
        // A wall's mean thickness.
        if (loss.volumeLeft < 1) loss.keepingVoxel = std::min(0.9, mVolume / mArea);
        if (mLost.empty()) {
            countLost(loss);
            return loss;
        }
        double lost = 0;
        loss.boxMin = loss.boxMax = mLost.front().place;
        for (const Lost& place : mLost) {
            lost += place.area;
            for (int axis = 0; axis < 3; ++axis) {
                loss.boxMin[axis] = std::min(loss.boxMin[axis], place.place[axis]);
                loss.boxMax[axis] = std::max(loss.boxMax[axis], place.place[axis]);
            }
        }
        loss.share = loss.outerArea > 0 ? std::min(1.0, lost / loss.outerArea) : 0;
        const double keeping = keepingVoxel(winding);
        loss.keepingVoxel =
            loss.volumeLeft < 1 && keeping > 0 ? std::min(keeping, loss.keepingVoxel) : keeping;
        countLost(loss);
        return loss;
    }

private:
    void findLost() {
        constexpr std::size_t kChunk = 256;
        const double density = std::min(1.0, kMostSamples / std::max(1.0, mArea));
        const std::size_t chunks = (mTriangles.size() + kChunk - 1) / kChunk;
        std::vector<std::vector<Lost>> lost(chunks);
        parallelFor(mContext, chunks, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t chunk = begin; chunk < end; ++chunk)
                for (std::size_t f = chunk * kChunk; f < std::min(mTriangles.size(), (chunk + 1) * kChunk);
                     ++f)
                    findLostOn(std::uint32_t(f), density, lost[chunk]);
        });
        for (const std::vector<Lost>& some : lost) mLost.insert(mLost.end(), some.begin(), some.end());
    }

    void findLostOn(std::uint32_t f, double density, std::vector<Lost>& lost) const {
        const Face face = faceOf(mMesh, mTriangles[f]);
        if (!(face.area > 0)) return;
        const std::size_t count = std::size_t(std::ceil(face.area * density));
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3d place = placeOn(face, i, count);
            if (!isNear(mResult, cast<float>(place), 0))
                lost.push_back({place, face.normal, face.area / double(count), f});
        }
    }

    // Parts of which the level set has no trace: nowhere just inside a solid is it solid, nowhere just inside
    // a void is it void. Beside another part they may yet be within a voxel of its surface.
    void findVanished() {
        mVanished.assign(mParts.parts.size(), 1);
        std::vector<std::size_t> tried(mParts.parts.size(), 0);
        for (std::size_t f = 0; f < mTriangles.size(); ++f) {
            const std::size_t part = mParts.partOf[f];
            const PartRole role = mParts.parts[part].role;
            if (role != PartRole::Solid && role != PartRole::Cavity) mVanished[part] = 0;
            if (!mVanished[part] || tried[part] > 4096) continue;
            const Face face = faceOf(mMesh, mTriangles[f]);
            const double side = role == PartRole::Solid ? -1 : 1;
            // No deeper than its middle.
            const Vec3d extent = mParts.parts[part].boxMax - mParts.parts[part].boxMin;
            const double deepest = std::min({extent.x, extent.y, extent.z}) / 2;
            for (std::size_t i = 0; i < 8 && mVanished[part]; ++i, ++tried[part])
                for (const double depth : {0.0, 0.25, 0.5, 1.0}) {
                    const Vec3d place = placeOn(face, i, 8) + face.normal * (side * std::min(depth, deepest));
                    const bool solid = sampleTrilinear(mResult, cast<float>(place)) < 0;
                    if (solid == (role == PartRole::Solid)) mVanished[part] = 0;
                }
        }
    }

    bool isInner(const WindingNumber& winding, const Vec3d& place, const Vec3d& normal) const {
        return winding.at(place + normal * kSideStep) > 0.5 && winding.at(place - normal * kSideStep) > 0.5;
    }

    bool isUnited(std::uint32_t face) const {
        return mParts.parts[mParts.partOf[face]].role == PartRole::United;
    }

    void dropInner(const WindingNumber& winding) {
        std::vector<char> inner(mLost.size());
        parallelFor(mContext, mLost.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                inner[i] = isUnited(mLost[i].face) || isInner(winding, mLost[i].place, mLost[i].normal);
        });
        std::size_t kept = 0;
        for (std::size_t i = 0; i < mLost.size(); ++i)
            if (!inner[i]) mLost[kept++] = mLost[i];
        mLost.resize(kept);
    }

    double outerShare(const WindingNumber& winding) const {
        const std::size_t step = std::max<std::size_t>(1, mTriangles.size() / kProbes);
        double outer = 0, all = 0;
        for (std::size_t f = 0; f < mTriangles.size(); f += step) {
            const Face face = faceOf(mMesh, mTriangles[f]);
            all += face.area;
            if (!isInner(winding, placeOn(face, 0, 1), face.normal)) outer += face.area;
        }
        return all > 0 ? outer / all : 1;
    }

    // How thick the solid is behind a place, or the void before it if that is thinner, in halving steps.
    double thicknessAt(const WindingNumber& winding, const Lost& lost) const {
        constexpr double kThinnest = 1.0 / 256;
        double t = 1;
        while (t >= kThinnest && (winding.at(lost.place - lost.normal * t) <= 0.5 ||
                                  winding.at(lost.place + lost.normal * t) > 0.5))
            t /= 2;
        return t >= kThinnest ? t : 0;
    }

    // The thickness that all but a tenth of what is lost has.
    double keepingVoxel(const WindingNumber& winding) const {
        const std::size_t step = std::max<std::size_t>(1, mLost.size() / 512);
        std::vector<double> thickness;
        for (std::size_t i = 0; i < mLost.size(); i += step)
            thickness.push_back(thicknessAt(winding, mLost[i]));
        std::sort(thickness.begin(), thickness.end());
        return std::min(0.9, thickness[thickness.size() / 10]);
    }

    void countLost(SurfaceLoss& loss) const {
        const MeshParts& parts = mParts;
        std::vector<double> lost(parts.parts.size(), 0);
        for (const Lost& place : mLost) lost[parts.partOf[place.face]] += place.area;
        const PartCounts counts = countParts(parts);
        loss.parts = parts.parts.size();
        loss.solids = counts.solids;
        loss.cavities = counts.cavities;
        for (std::size_t i = 0; i < lost.size(); ++i) {
            const bool gone = mVanished[i] || lost[i] > 0.5 * parts.parts[i].area;
            const PartRole role = parts.parts[i].role;
            if (mVanished[i] && loss.keepingVoxel == 0) {
                const Vec3d extent = parts.parts[i].boxMax - parts.parts[i].boxMin;
                loss.keepingVoxel = std::min({0.9, extent.x, extent.y, extent.z});
            }
            loss.lostSolids += gone && role == PartRole::Solid ? 1 : 0;
            loss.lostCavities += gone && role == PartRole::Cavity ? 1 : 0;
            loss.lostOpen += gone && role == PartRole::Open ? 1 : 0;
        }
    }

    const Mesh& mMesh;
    std::vector<Triangle> mTriangles;
    const BrickField& mResult;
    const RunContext& mContext;
    double mArea = 0, mVolume = 0;  // [voxels^2], [voxels^3] or 0 if it is open
    std::vector<Lost> mLost;
    MeshParts mParts;
    std::vector<char> mVanished;  // of each part
};

}  // namespace

SurfaceLoss surfaceLoss(const Mesh& mesh, const BrickField& result, const RunContext& ctx) {
    return Comparison(mesh, result, ctx).run();
}

double pointLoss(const std::vector<Vec3f>& points, const std::vector<float>& reach, const BrickField& result,
                 const RunContext& ctx) {
    constexpr std::size_t kChunk = 1024;
    std::vector<std::size_t> far((points.size() + kChunk - 1) / kChunk, 0);
    parallelFor(ctx, far.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t chunk = begin; chunk < end; ++chunk)
            for (std::size_t i = chunk * kChunk; i < std::min(points.size(), (chunk + 1) * kChunk); ++i)
                far[chunk] += isNear(result, points[i], std::min(reach[i], 2.f)) ? 0 : 1;
    });
    std::size_t lost = 0;
    for (std::size_t some : far) lost += some;
    return points.empty() ? 0 : double(lost) / double(points.size());
}

}  // namespace vdbsynth
