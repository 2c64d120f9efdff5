#include "libvdbsynth/measure/verdict.h"

#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// Nearest rank: the smallest of the values that three quarters of them do not exceed.
double upperQuartile(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0 : values[(values.size() * 3 + 3) / 4 - 1];
}

double rootMeanSquare(const std::vector<double>& values, double divisor) {
    double squares = 0;
    for (double value : values) squares += value * value;
    return std::sqrt(squares / divisor);
}

}  // namespace

std::vector<IndexBox> subVolumes(const IndexBox& box, const std::array<bool, 3>& stationary, int shortest) {
    const int axes = int(std::count(stationary.begin(), stationary.end(), true));
    const int parts = axes == 3 ? 2 : axes == 2 ? 3 : axes == 1 ? 8 : 0;
    if (parts == 0) return {};
    Index3 count{1, 1, 1}, side = box.size();
    for (int axis = 0; axis < 3; ++axis)
        if (stationary[std::size_t(axis)]) {
            count[axis] = parts;
            side[axis] /= parts;
            if (side[axis] < shortest) return {};
        }
    std::vector<IndexBox> boxes;
    forEachVoxel(IndexBox::fromSize(count), [&](const Index3& p) {
        const Index3 low = box.min + Index3{p.x * side.x, p.y * side.y, p.z * side.z};
        boxes.push_back({low, low + side - Index3{1, 1, 1}});
    });
    return boxes;
}

Statistic meanOf(const std::vector<Statistic>& parts) {
    Statistic mean = parts.front();
    for (std::size_t i = 0; i < mean.values.size(); ++i) {
        double sum = 0;
        for (const Statistic& part : parts) sum += part.values[i];
        mean.values[i] = sum / double(parts.size());
    }
    return mean;
}

Verdict judge(const std::vector<Statistic>& parts, const Statistic& result) {
    const Statistic mean = meanOf(parts);
    std::vector<double> distances;
    for (const Statistic& part : parts) distances.push_back(statisticDistance(part, mean));
    Verdict verdict;
    verdict.name = result.name;
    verdict.mean = mean.values.size() == 1 ? mean.values.front() : 0;
    verdict.sigma = rootMeanSquare(distances, double(parts.size()) - 1);
    verdict.quartile = upperQuartile(distances);
    verdict.distance = statisticDistance(result, mean);
    return verdict;
}

double fractionError(const std::vector<double>& radial, double fraction, double volume) {
    constexpr double kPi = 3.14159265358979323846;
    const double square = fraction * fraction;
    double sum = 0;
    for (std::size_t r = 0; r < radial.size() && radial[r] > square; ++r)
        sum += (r == 0 ? 1 : 4 * kPi * (double(r) * double(r) + 1.0 / 12)) * (radial[r] - square);
    return volume > 0 ? std::sqrt(sum / volume) : 0;
}

Verdict judgeFraction(const std::vector<Statistic>& exemplar, double volume,
                      const std::vector<Statistic>& result) {
    const auto valuesOf = [](const std::vector<Statistic>& all, const std::string& name) {
        for (const Statistic& one : all)
            if (one.name == name) return one.values;
        return std::vector<double>{};
    };
    Verdict verdict;
    verdict.name = "volume fraction, standard error";
    const std::vector<double> own = valuesOf(exemplar, "volume fraction"),
                              other = valuesOf(result, "volume fraction"),
                              radial = valuesOf(exemplar, "two-point correlation");
    if (own.empty() || other.empty()) return verdict;
    verdict.mean = own.front();
    verdict.sigma = fractionError(radial, own.front(), volume);
    verdict.quartile = 2 * verdict.sigma;
    verdict.distance = std::abs(other.front() - own.front());
    return verdict;
}

const Verdict* findVerdict(const std::vector<Verdict>& verdicts, const std::string& name) {
    for (const Verdict& verdict : verdicts)
        if (verdict.name == name) return &verdict;
    return nullptr;
}

Verdict judgeDistance(const std::string& name, const std::vector<double>& parts, double result) {
    Verdict verdict;
    verdict.name = name;
    verdict.sigma = rootMeanSquare(parts, double(parts.size()));
    verdict.quartile = upperQuartile(parts);
    verdict.distance = result;
    return verdict;
}

}  // namespace vdbsynth
