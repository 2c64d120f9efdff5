#include "libvdbsynth/patch/scanline/thin_plate_warp.h"

#include "libvdbsynth/base/error.h"

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kLeastSmoothing = 1e-9;  // so that two equal places are no error

}  // namespace

ThinPlateWarp::ThinPlateWarp(std::vector<Vec3d> from, const std::vector<Vec3d>& to, double smoothing)
    : mFrom(std::move(from)) {
    if (mFrom.size() != to.size())
        throw Error(ErrorCode::ShapeMismatch, "a warp's places and their images differ in number");
    if (mFrom.size() < kLeastPairs || mFrom.size() > kMostPairs)
        throw Error(ErrorCode::InvalidOption, "a thin-plate warp takes 4 to 4096 pairs");
    for (const Vec3d& place : mFrom) mMiddle = mMiddle + place * (1.0 / double(mFrom.size()));
    for (Vec3d& place : mFrom) place = place - mMiddle;
    const auto count = Eigen::Index(mFrom.size());
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(count + 4, count + 4);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count + 4, 3);
    for (Eigen::Index i = 0; i < count; ++i) {
        const Vec3d& p = mFrom[std::size_t(i)];
        for (Eigen::Index j = 0; j < i; ++j) system(i, j) = system(j, i) = length(p - mFrom[std::size_t(j)]);
        // |x| is negative definite on what the side conditions leave: smoothing has the other sign.
        system(i, i) = -(smoothing + kLeastSmoothing);
        const double affine[4] = {1, p.x, p.y, p.z};
        for (Eigen::Index a = 0; a < 4; ++a) system(i, count + a) = system(count + a, i) = affine[a];
        const Vec3d move = to[std::size_t(i)] - p - mMiddle;  // the identity is added in `at`
        right.row(i) << move.x, move.y, move.z;
    }
    // Places on a plane leave A undetermined across it: the least change is none.
    for (Eigen::Index a = 1; a < 4; ++a) system(count + a, count + a) = 1e-9;
    const Eigen::MatrixXd solved = system.partialPivLu().solve(right);
    const auto row = [&](Eigen::Index r) { return Vec3d{solved(r, 0), solved(r, 1), solved(r, 2)}; };
    for (Eigen::Index i = 0; i < count; ++i) mWeights.push_back(row(i));
    mConstant = row(count);
    for (int axis = 0; axis < 3; ++axis) mLinear[axis] = row(count + 1 + axis);
}

WarpedPlace ThinPlateWarp::at(const Vec3d& place) const {
    const Vec3d x = place - mMiddle;
    WarpedPlace warped{place + mConstant, {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}};
    for (int axis = 0; axis < 3; ++axis) {
        warped.place = warped.place + mLinear[axis] * x[axis];
        warped.jacobian[std::size_t(axis)] = warped.jacobian[std::size_t(axis)] + mLinear[axis];
    }
    for (std::size_t i = 0; i < mFrom.size(); ++i) {
        const Vec3d from = x - mFrom[i];
        const double r = length(from);
        if (r < 1e-300) continue;
        warped.place = warped.place + mWeights[i] * r;
        for (int axis = 0; axis < 3; ++axis)
            warped.jacobian[std::size_t(axis)] =
                warped.jacobian[std::size_t(axis)] + mWeights[i] * (from[axis] / r);
    }
    return warped;
}

}  // namespace vdbsynth
