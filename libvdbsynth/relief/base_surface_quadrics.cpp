// The paper's base: a quadric by weighted least squares around every point of the surface.
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/relief/base_surface_steps.h"
#include "libvdbsynth/surface/surface_shell.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr int kTerms = 6;          // 1 u v u^2 uv v^2
constexpr double kRadii = 2.5;     // of the neighbourhood
constexpr double kRidge = 1e-9;    // of the largest diagonal, where points are too few
constexpr float kSameSide = 0.2f;  // cosine between normals of one side of a wall
constexpr float kMargin = 3;       // [samples]

using Matrix = std::array<std::array<double, kTerms>, kTerms>;

// The first unknown of a symmetric positive system, by Cholesky's decomposition.
double firstUnknown(Matrix m, std::array<double, kTerms> right) {
    double largest = 0;
    for (int i = 0; i < kTerms; ++i) largest = std::max(largest, m[std::size_t(i)][std::size_t(i)]);
    for (std::size_t i = 0; i < kTerms; ++i) {
        m[i][i] += kRidge * largest + 1e-30;
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = m[i][j];
            for (std::size_t k = 0; k < j; ++k) sum -= m[i][k] * m[j][k];
            m[i][j] = i == j ? std::sqrt(std::max(sum, 1e-30)) : sum / m[j][j];
        }
    }
    for (std::size_t i = 0; i < kTerms; ++i) {
        for (std::size_t k = 0; k < i; ++k) right[i] -= m[i][k] * right[k];
        right[i] /= m[i][i];
    }
    for (std::size_t i = kTerms; i-- > 0;) {
        for (std::size_t k = i + 1; k < kTerms; ++k) right[i] -= m[k][i] * right[k];
        right[i] /= m[i][i];
    }
    return right[0];
}

// How high the quadric around a point is above it, along a normal.
float heightOfQuadric(const SurfaceShell& shell, std::size_t i, const Vec3f& normal,
                      const std::vector<ShellNeighbour>& near, double radius) {
    const Vec3f aside = std::abs(normal.x) < 0.6f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
    const Vec3f u = normalized(cross(normal, aside)), v = cross(normal, u);
    Matrix matrix{};
    std::array<double, kTerms> right{};
    for (const ShellNeighbour& n : near) {
        if (dot(shell.normal[n.site], normal) < kSameSide) continue;
        const Vec3f apart = shell.point[n.site] - shell.point[i];
        const double a = double(dot(apart, u)) / radius, b = double(dot(apart, v)) / radius;
        const double weight = double(spreadOf(n.squared, radius));
        const std::array<double, kTerms> terms{1, a, b, a * a, a * b, b * b};
        for (std::size_t row = 0; row < kTerms; ++row) {
            for (std::size_t column = 0; column < kTerms; ++column)
                matrix[row][column] += weight * terms[row] * terms[column];
            right[row] += weight * terms[row] * double(dot(apart, normal));
        }
    }
    return float(std::clamp(firstUnknown(matrix, right), -2 * radius, 2 * radius));
}

}  // namespace

SmoothField distancesByQuadrics(const SmoothField& distances, double radius, const RunContext& ctx) {
    const BrickField unit = scaledField(distances.field, 1 / float(distances.step), ctx);
    const double samples = radius / distances.step;
    const SurfaceShell shell = surfaceShell(unit, ctx);
    std::vector<Vec3f> mean(shell.size()), height(shell.size());
    forShellNeighbours(
        shell, kRadii * samples, ctx, [&](std::size_t i, const std::vector<ShellNeighbour>& near) {
            Vec3f sum;
            for (const ShellNeighbour& n : near)
                if (dot(shell.normal[i], shell.normal[n.site]) > 0)
                    sum = sum + shell.normal[n.site] * spreadOf(n.squared, samples);
            mean[i] = normalized(sum);
            height[i].x = heightOfQuadric(shell, i, mean[i], near, samples) * dot(mean[i], shell.normal[i]);
        });
    const float reach = float(samples) + kMargin;
    const VoxelTable band = VoxelTable::where(
        unit, [&](float d) { return std::abs(d) < reach; }, ctx);
    const std::vector<Vec3f> extended = extendedOverBand(unit, band, shell, height, ctx);
    const BrickField field = BrickField::fromVoxels(unit.box(), ctx, [&](const Index3& p) {
        const std::int32_t i = band.find(p);
        return (unit.at(p) - (i < 0 ? 0.f : extended[std::size_t(i)].x)) * float(distances.step);
    });
    return {field, distances.step};
}

}  // namespace vdbsynth
