#include "libvdbsynth/geometry/quadric.h"

#include <Eigen/Eigenvalues>

namespace vdbsynth {

void Quadric::add(const Vec3d& n, const Vec3d& point, double weight) {
    const double entries[6] = {n.x * n.x, n.x * n.y, n.x * n.z, n.y * n.y, n.y * n.z, n.z * n.z};
    for (int i = 0; i < 6; ++i) mMatrix[i] += weight * entries[i];
    mVector = mVector + n * (weight * dot(n, point));
    mWeight += weight;
}

void Quadric::add(const Quadric& other) {
    for (int i = 0; i < 6; ++i) mMatrix[i] += other.mMatrix[i];
    mVector = mVector + other.mVector;
    mWeight += other.mWeight;
}

Vec3d Quadric::mainNormal() const {
    Eigen::Matrix3d matrix;
    matrix << mMatrix[0], mMatrix[1], mMatrix[2], mMatrix[1], mMatrix[3], mMatrix[4], mMatrix[2], mMatrix[4],
        mMatrix[5];
    const Eigen::Vector3d normal =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvectors().col(2);
    return {normal.x(), normal.y(), normal.z()};
}

Quadric::Minimum Quadric::minimum(const Vec3d& start, double edgeCut, double cornerCut) const {
    Minimum result{start, 0};
    if (empty()) return result;
    Eigen::Matrix3d matrix;
    matrix << mMatrix[0], mMatrix[1], mMatrix[2], mMatrix[1], mMatrix[3], mMatrix[4], mMatrix[2], mMatrix[4],
        mMatrix[5];
    const Eigen::Vector3d from(start.x, start.y, start.z), right(mVector.x, mVector.y, mVector.z);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
    const Eigen::Vector3d missing = right - matrix * from;
    Eigen::Vector3d move = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
        const double value = solver.eigenvalues()[i];
        const double cut = i == 0 ? cornerCut : i == 1 ? edgeCut : 0;
        if (!(value > cut * solver.eigenvalues()[2])) continue;
        const Eigen::Vector3d direction = solver.eigenvectors().col(i);
        move += direction * (direction.dot(missing) / value);
        ++result.rank;
    }
    result.point = start + Vec3d{move.x(), move.y(), move.z()};
    return result;
}

}  // namespace vdbsynth
