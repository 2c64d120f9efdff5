#include "libvdbsynth/patch/sheet/compact_warp.h"

#include "libvdbsynth/base/error.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>

namespace vdbsynth {
namespace {

constexpr double kSmoothing = 0.02;  // lambda
constexpr int kMostHalvings = 8;

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
}

WarpedPlace CompactWarp::at(const Vec3d& place) const {
    WarpedPlace warped{place, {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}};
    const double reach = mRadius * mRadius;
    for (std::size_t i = 0; i < mCentres.size(); ++i) {
        const Vec3d from = place - mCentres[i];
        const double squared = dot(from, from);
        if (squared >= reach) continue;
        const double r = std::sqrt(squared) / mRadius, rest = 1 - r;
        warped.place = warped.place + mWeights[i] * wendland(r);
        const double slope = -20 * rest * rest * rest / reach;  // phi'(r) / (r R^2)
        for (int axis = 0; axis < 3; ++axis)
            warped.jacobian[std::size_t(axis)] =
                warped.jacobian[std::size_t(axis)] + mWeights[i] * (slope * from[axis]);
    }
    return warped;
}

double CompactWarp::unfold(const std::vector<Vec3d>& places, double least) {
    double factor = 1;
    for (int halving = 0; halving < kMostHalvings; ++halving) {
        const bool holds = std::all_of(places.begin(), places.end(), [&](const Vec3d& place) {
            return determinant(at(place).jacobian) > least;
        });
        if (holds) return factor;
        for (Vec3d& weight : mWeights) weight = weight * 0.5;
        factor *= 0.5;
    }
    mCentres.clear();
    mWeights.clear();
    return 0;
}

}  // namespace vdbsynth
