#include "libvdbsynth/patch/sheet/compact_warp.h"

#include "libvdbsynth/base/error.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kSmoothing = 0.02;  // lambda
constexpr int kMostHalvings = 8;
constexpr std::size_t kLanes = 8;

const std::array<Vec3d, 3> kUnmoved{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};

double wendland(double r) {
    const double rest = 1 - r, square = rest * rest;
    return square * square * (4 * r + 1);
}

}  // namespace

CompactWarp::CompactWarp(std::vector<Vec3d> centres, const std::vector<Vec3d>& moves, double radius)
    : mCentres(std::move(centres)), mRadius(radius) {
    if (mCentres.size() != moves.size())
        throw Error(ErrorCode::ShapeMismatch, "a warp's centres and moves differ in number");
    if (!(radius > 0) || mCentres.size() > kMostCentres)
        throw Error(ErrorCode::InvalidOption, "a warp needs a radius above 0 and at most 1024 centres");
    const auto count = Eigen::Index(mCentres.size());
    if (count == 0) return;
    Eigen::MatrixXd kernel(count, count), right(count, 3);
    for (Eigen::Index i = 0; i < count; ++i) {
        const std::size_t row = std::size_t(i);
        for (Eigen::Index j = 0; j <= i; ++j) {
            const double r = length(mCentres[row] - mCentres[std::size_t(j)]) / radius;
            kernel(i, j) = kernel(j, i) = r < 1 ? wendland(r) : 0;
        }
        kernel(i, i) += kSmoothing;
        right.row(i) << moves[row].x, moves[row].y, moves[row].z;
    }
    const Eigen::MatrixXd weights = kernel.ldlt().solve(right);
    for (Eigen::Index i = 0; i < count; ++i)
        mWeights.push_back({weights(i, 0), weights(i, 1), weights(i, 2)});
    constexpr float kNowhere = 1e18f;
    mX.assign((mCentres.size() + kLanes - 1) / kLanes * kLanes, kNowhere);
    mY = mZ = mX;
    for (std::size_t c = 0; c < mCentres.size(); ++c) {
        mX[c] = float(mCentres[c].x);
        mY[c] = float(mCentres[c].y);
        mZ[c] = float(mCentres[c].z);
    }
}

// Floats may err: a little more than the radius. Visits in the order of the centres.
template <typename Visit>
void CompactWarp::forNear(const Vec3f& place, Visit&& visit) const {
    const float most = 1.001f * float(mRadius * mRadius);
    for (std::size_t first = 0; first < mX.size(); first += kLanes) {
        float squared[kLanes];
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const float x = mX[first + lane] - place.x, y = mY[first + lane] - place.y,
                        z = mZ[first + lane] - place.z;
            squared[lane] = x * x + y * y + z * z;
        }
        unsigned near = 0;
        for (std::size_t lane = 0; lane < kLanes; ++lane) near |= unsigned(squared[lane] < most) << lane;
        for (std::size_t lane = 0; near != 0; ++lane, near >>= 1)
            if (near & 1) visit(first + lane);
    }
}

WarpedPlace CompactWarp::at(const Vec3d& place) const {
    WarpedPlace warped{place, kUnmoved};
    const double reach = mRadius * mRadius;
    forNear(cast<float>(place), [&](std::size_t i) {
        const Vec3d from = place - mCentres[i];
        const double squared = dot(from, from);
        if (squared >= reach) return;
        const double r = std::sqrt(squared) / mRadius, rest = 1 - r;
        warped.place = warped.place + mWeights[i] * wendland(r);
        const double slope = -20 * rest * rest * rest / reach;  // phi'(r) / (r R^2)
        for (int axis = 0; axis < 3; ++axis)
            warped.jacobian[std::size_t(axis)] =
                warped.jacobian[std::size_t(axis)] + mWeights[i] * (slope * from[axis]);
    });
    return warped;
}

// Moves and Jacobians less the identity are in proportion to the weights: places are warped once.
CompactWarp::Unfolded CompactWarp::unfold(const std::vector<Vec3d>& places, double least) {
    Unfolded result;
    result.places.reserve(places.size());
    for (const Vec3d& place : places) result.places.push_back(at(place));
    for (int halving = 0; halving < kMostHalvings; ++halving) {
        const bool holds = std::all_of(result.places.begin(), result.places.end(),
                                       [&](const WarpedPlace& w) { return determinant(w.jacobian) > least; });
        if (holds) return result;
        result.factor *= 0.5;
        for (Vec3d& weight : mWeights) weight = weight * 0.5;
        for (std::size_t p = 0; p < places.size(); ++p) {
            WarpedPlace& warped = result.places[p];
            warped.place = places[p] + (warped.place - places[p]) * 0.5;
            for (std::size_t axis = 0; axis < 3; ++axis)
                warped.jacobian[axis] = (warped.jacobian[axis] + kUnmoved[axis]) * 0.5;
        }
    }
    *this = CompactWarp({}, {}, mRadius);
    for (std::size_t p = 0; p < places.size(); ++p) result.places[p] = {places[p], kUnmoved};
    result.factor = 0;
    return result;
}

}  // namespace vdbsynth
