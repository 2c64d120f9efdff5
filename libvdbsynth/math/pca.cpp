#include "libvdbsynth/math/pca.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace vdbsynth {

void PrincipalAxes::project(const float* vector, float* out) const {
    for (std::size_t i = 0; i < count; ++i) {
        const float* axis = axes.data() + i * length;
        float sum = 0;
        for (std::size_t k = 0; k < length; ++k) sum += axis[k] * (vector[k] - mean[k]);
        out[i] = sum;
    }
}

PrincipalAxes principalAxes(const std::vector<float>& vectors, std::size_t length, std::size_t most,
                            double share) {
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Index n = Eigen::Index(length), rows = Eigen::Index(vectors.size() / length);
    const Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> data(
        vectors.data(), rows, n);
    Matrix centred = data.cast<double>();
    const Eigen::RowVectorXd mean = centred.colwise().mean();
    centred.rowwise() -= mean;
    const Matrix covariance = centred.transpose() * centred / double(std::max<Eigen::Index>(rows, 1));
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance);
    PrincipalAxes result;
    result.length = length;
    for (Eigen::Index k = 0; k < n; ++k) result.mean.push_back(float(mean(k)));
    const double total = std::max(solver.eigenvalues().sum(), 1e-300);
    double sum = 0;
    while (result.count < std::min(most, length) && (result.count == 0 || sum / total < share)) {
        const Eigen::Index column = n - 1 - Eigen::Index(result.count);
        Eigen::VectorXd axis = solver.eigenvectors().col(column);
        Eigen::Index largest;
        axis.cwiseAbs().maxCoeff(&largest);
        if (axis(largest) < 0) axis = -axis;
        for (Eigen::Index k = 0; k < n; ++k) result.axes.push_back(float(axis(k)));
        sum += std::max(solver.eigenvalues()(column), 0.0);
        ++result.count;
    }
    result.explained = std::min(1.0, sum / total);
    return result;
}

PointAxes pointAxes(const PointSums& sums, bool aboutMean) {
    PointAxes axes;
    if (sums.count == 0) {
        for (int k = 0; k < 3; ++k) axes.axis[k][k] = 1;
        return axes;
    }
    const double part = 1 / double(sums.count);
    axes.mean = sums.first * part;
    const Vec3d m = aboutMean ? axes.mean : Vec3d{};
    Eigen::Matrix3d moment;
    moment << sums.xx * part - m.x * m.x, sums.xy * part - m.x * m.y, sums.xz * part - m.x * m.z, 0,
        sums.yy * part - m.y * m.y, sums.yz * part - m.y * m.z, 0, 0, sums.zz * part - m.z * m.z;
    const Eigen::Matrix3d full = moment.selfadjointView<Eigen::Upper>();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(full);
    for (int k = 0; k < 3; ++k) {
        Eigen::Vector3d axis = solver.eigenvectors().col(k);
        Eigen::Index largest;
        axis.cwiseAbs().maxCoeff(&largest);
        if (axis(largest) < 0) axis = -axis;
        axes.axis[k] = {axis.x(), axis.y(), axis.z()};
        axes.variance[k] = std::max(solver.eigenvalues()(k), 0.0);
    }
    return axes;
}

}  // namespace vdbsynth
