#include "libvdbsynth/math/least_squares.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>

namespace vdbsynth {

AffineMap fitAffine(const std::vector<float>& vectors, std::size_t length, const std::vector<float>& values,
                    double ridge) {
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    using Rows = Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
    const Eigen::Index n = Eigen::Index(length), rows = Eigen::Index(values.size());
    const Rows data(vectors.data(), rows, n);
    const Eigen::Map<const Eigen::VectorXf> wanted(values.data(), rows);
    const double count = double(std::max<Eigen::Index>(rows, 1));
    const Eigen::RowVectorXd mean = data.cast<double>().colwise().sum() / count;
    const double middle = wanted.cast<double>().sum() / count;
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd with = Eigen::VectorXd::Zero(n);
    // Converts a part of the rows at a time to double; all of them would take three times their memory.
    constexpr Eigen::Index kPart = 4096;
    for (Eigen::Index first = 0; first < rows; first += kPart) {
        const Eigen::Index part = std::min(kPart, rows - first);
        Matrix centred = data.middleRows(first, part).cast<double>();
        centred.rowwise() -= mean;
        covariance.selfadjointView<Eigen::Lower>().rankUpdate(centred.transpose());
        with += centred.transpose() * (wanted.segment(first, part).cast<double>().array() - middle).matrix();
    }
    covariance.diagonal().array() += std::max(ridge * covariance.trace() / double(n), 1e-30);
    const Eigen::VectorXd weights = covariance.selfadjointView<Eigen::Lower>().ldlt().solve(with);
    AffineMap map;
    for (Eigen::Index k = 0; k < n; ++k) map.weights.push_back(float(weights(k)));
    map.constant = float(middle - mean * weights);
    return map;
}

}  // namespace vdbsynth
