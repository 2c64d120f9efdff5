#include "libvdbsynth/points/point_set_surface_steps.h"

#include <algorithm>
#include <cmath>

// Algebraic spheres in closed form [guennebaud2008, Eqs. 4-6], robust planes [oztireli2009, Eqs. 10-17]. The
// weights of both are powers of a parabola, not Gaussians: they end, and need no exponential.
namespace vdbsynth {
namespace {

typedef float Lanes __attribute__((vector_size(32)));

constexpr double kSmooth = 0.02, kSharp = 0.06;  // variance of normals, see creaseShare
constexpr double kResidualWidth = 0.5;           // RIMLS's sigma_r over h [oztireli2009, 4.2]
constexpr int kRounds = 6;                       // of RIMLS at most

double sumOf(const Lanes& lanes) {
    return ((double(lanes[0]) + double(lanes[1])) + (double(lanes[2]) + double(lanes[3]))) +
           ((double(lanes[4]) + double(lanes[5])) + (double(lanes[6]) + double(lanes[7])));
}

// Weighted sums over points p, relative to a place, and normals n.
struct Sums {
    double weight = 0;
    Vec3d p, n;
    double np = 0, pp = 0;
};

__attribute__((target_clones("avx2", "default"))) Sums sumsOf(const std::vector<PointPack>& packs,
                                                              const Vec3f& place) {
    Lanes sum[9] = {};
    for (const PointPack& pack : packs) {
        const Lanes x = pack.x - place.x, y = pack.y - place.y, z = pack.z - place.z;
        const Lanes squared = x * x + y * y + z * z;
        const Lanes beyond = 1 - squared * pack.inverse;
        const Lanes u = beyond > 0 ? beyond : Lanes{};
        const Lanes w = (u * u) * (u * u) * pack.share;
        sum[0] += w;
        sum[1] += w * x;
        sum[2] += w * y;
        sum[3] += w * z;
        sum[4] += w * pack.normalX;
        sum[5] += w * pack.normalY;
        sum[6] += w * pack.normalZ;
        sum[7] += w * (pack.normalX * x + pack.normalY * y + pack.normalZ * z);
        sum[8] += w * squared;
    }
    double total[9];
    for (int k = 0; k < 9; ++k) total[k] = sumOf(sum[k]);
    Sums sums;
    sums.weight = total[0];
    sums.p = {total[1], total[2], total[3]};
    sums.n = {total[4], total[5], total[6]};
    sums.np = total[7];
    sums.pp = total[8];
    return sums;
}

// Weighted second moments about the means: of the points, and of normals (rows) with points (columns).
struct Moments {
    double pp[3][3] = {}, np[3][3] = {};
};

__attribute__((target_clones("avx2", "default"))) Moments momentsOf(const std::vector<PointPack>& packs,
                                                                    const Vec3f& place, const Sums& sums) {
    Lanes pp[3][3] = {}, np[3][3] = {};
    for (const PointPack& pack : packs) {
        const Lanes p[3] = {pack.x - place.x, pack.y - place.y, pack.z - place.z};
        const Lanes* const n[3] = {&pack.normalX, &pack.normalY, &pack.normalZ};
        const Lanes beyond = 1 - (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) * pack.inverse;
        const Lanes u = beyond > 0 ? beyond : Lanes{};
        const Lanes w = (u * u) * (u * u) * pack.share;
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) {
                pp[i][j] += w * p[i] * p[j];
                np[i][j] += w * *n[i] * p[j];
            }
    }
    Moments moments;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double w = sums.weight, mean = sums.p[j] / w;
            moments.pp[i][j] = sumOf(pp[i][j]) / w - sums.p[i] / w * mean;
            moments.np[i][j] = sumOf(np[i][j]) / w - sums.n[i] / w * mean;
        }
    return moments;
}

// The part of the variance of the normals that a linear map of the points explains: tr(B A^-1 B^T).
double explainedVariance(const Moments& moments) {
    double a[3][3];
    const double trace = moments.pp[0][0] + moments.pp[1][1] + moments.pp[2][2];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) a[i][j] = moments.pp[i][j] + (i == j ? 1e-4 * trace : 0);
    const Vec3d rows[3] = {
        {a[0][0], a[0][1], a[0][2]}, {a[1][0], a[1][1], a[1][2]}, {a[2][0], a[2][1], a[2][2]}};
    const Vec3d columns[3] = {cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])};
    const double determinant = dot(rows[0], columns[0]);
    if (!(determinant > 0)) return 0;
    double explained = 0;
    for (const auto& row : moments.np) {
        const Vec3d b{row[0], row[1], row[2]};
        const Vec3d solved = (columns[0] * b.x + columns[1] * b.y + columns[2] * b.z) * (1 / determinant);
        explained += dot(b, solved);
    }
    return explained;
}

SurfaceFit planeOf(const Sums& sums) {
    SurfaceFit fit;
    fit.linear = normalized(sums.n);
    fit.constant = -dot(fit.linear, sums.p) / sums.weight;
    return fit;
}

SurfaceFit sphereOf(const Sums& sums) {
    const double w = sums.weight, spread = sums.pp - dot(sums.p, sums.p) / w;
    SurfaceFit fit;
    if (spread > 0) fit.square = 0.5 * (sums.np - dot(sums.p, sums.n) / w) / spread;
    fit.linear = (sums.n - sums.p * (2 * fit.square)) * (1 / w);
    fit.constant = -(dot(sums.p, fit.linear) + fit.square * sums.pp) / w;
    return fit;
}

// How much a place lies at a crease: by the variance of the normals around it that curvature, a linear map
// of the points, does not explain. Cheap bounds first: of a sphere all is explained.
double creaseShare(const std::vector<PointPack>& packs, const Vec3f& place, const Sums& sums,
                   const SurfaceFit& sphere) {
    const double w = sums.weight, variance = 1 - dot(sums.n, sums.n) / (w * w);
    const double bySphere = 2 * sphere.square * (sums.np - dot(sums.p, sums.n) / w) / w;
    if (variance - bySphere <= kSmooth) return 0;
    const double left = variance - explainedVariance(momentsOf(packs, place, sums));
    const double part = std::min(std::max((left - kSmooth) / (kSharp - kSmooth), 0.0), 1.0);
    return part * part * (3 - 2 * part);
}

// What the robust weights of the next round are made of.
struct RobustPlane {
    float constant = 0;
    Vec3f linear;
    float inverseResidual = 0, inverseNormal = 0;  // 1 / (8 sigma^2); 0: all the same
};

__attribute__((target_clones("avx2", "default"))) SurfaceFit robustRound(const std::vector<PointPack>& packs,
                                                                         const Vec3f& place,
                                                                         const RobustPlane& last) {
    Lanes sum[11] = {};
    for (const PointPack& pack : packs) {
        const Lanes x = pack.x - place.x, y = pack.y - place.y, z = pack.z - place.z;
        const Lanes beyond = 1 - (x * x + y * y + z * z) * pack.inverse;
        const Lanes u = beyond > 0 ? beyond : Lanes{};
        const Lanes f = -(pack.normalX * x + pack.normalY * y + pack.normalZ * z);
        const Lanes turnX = pack.normalX - last.linear.x, turnY = pack.normalY - last.linear.y,
                    turnZ = pack.normalZ - last.linear.z;
        const Lanes off = f - last.constant;
        const Lanes rest = 1 - off * off * last.inverseResidual -
                           (turnX * turnX + turnY * turnY + turnZ * turnZ) * last.inverseNormal;
        const Lanes e = rest > 0 ? rest : Lanes{};
        const Lanes e4 = (e * e) * (e * e), factor = e4 * e4 * pack.share * (u * u * u);
        const Lanes w = factor * u, slope = 8 * factor * pack.inverse;
        sum[0] += w;
        sum[1] += w * f;
        sum[2] += w * pack.normalX;
        sum[3] += w * pack.normalY;
        sum[4] += w * pack.normalZ;
        sum[5] += slope * x;
        sum[6] += slope * y;
        sum[7] += slope * z;
        sum[8] += slope * x * f;
        sum[9] += slope * y * f;
        sum[10] += slope * z * f;
    }
    double total[11];
    for (int k = 0; k < 11; ++k) total[k] = sumOf(sum[k]);
    SurfaceFit fit;
    if (!(total[0] > 0)) return fit;
    fit.constant = total[1] / total[0];
    fit.linear = (Vec3d{total[8], total[9], total[10]} - Vec3d{total[5], total[6], total[7]} * fit.constant +
                  Vec3d{total[2], total[3], total[4]}) *
                 (1 / total[0]);
    return fit;
}

SurfaceFit robustPlaneOf(const std::vector<PointPack>& packs, const Vec3f& place, float spread,
                         const PointSetSurfaceOptions& options) {
    SurfaceFit fit = robustRound(packs, place, {});
    RobustPlane plane;
    plane.inverseResidual =
        float(1 / (8 * kResidualWidth * kResidualWidth * double(spread) * double(spread)));
    plane.inverseNormal = float(1 / (8 * options.normalWidth * options.normalWidth));
    for (int round = 1; round < kRounds; ++round) {
        plane.constant = float(fit.constant);
        plane.linear = cast<float>(fit.linear);
        const SurfaceFit next = robustRound(packs, place, plane);
        if (!(dot(next.linear, next.linear) > 0)) break;
        const Vec3d change = next.linear - fit.linear;
        fit = next;
        if (dot(change, change) < 1e-6) break;
    }
    return fit;
}

}  // namespace

// Along the gradient g at the place, to the nearer root of u(place + t g) = 0.
std::optional<SurfaceFit::Foot> SurfaceFit::foot(const Vec3d& place) const {
    const double value = constant + dot(linear, place) + square * dot(place, place);
    const Vec3d gradient = linear + place * (2 * square);
    const double squared = dot(gradient, gradient), root = squared - 4 * value * square;
    if (!(squared > 0) || !(root > 0)) return {};
    const double size = std::sqrt(squared), step = -2 * value / (squared + size * std::sqrt(root));
    return Foot{place + gradient * step, gradient * (1 / size), -step * size};
}

std::optional<SurfaceFit::Foot> SurfaceFits::foot(const Vec3d& place) const {
    if (crease <= 0) return smooth.foot(place);
    const std::optional<SurfaceFit::Foot> b = sharp.foot(place);
    if (crease >= 1) return b;
    const std::optional<SurfaceFit::Foot> a = smooth.foot(place);
    if (!a || !b) return a ? a : b;
    return SurfaceFit::Foot{a->point * (1 - crease) + b->point * crease,
                            normalized(a->normal * (1 - crease) + b->normal * crease),
                            a->distance * (1 - crease) + b->distance * crease};
}

std::optional<SurfaceFits> fitSurface(const std::vector<PointPack>& packs, const Vec3f& place, float spread,
                                      const PointSetSurfaceOptions& options) {
    SurfaceFits fits;
    if (options.kind == PointSetKind::Rimls) {
        fits.sharp = robustPlaneOf(packs, place, spread, options);
        fits.crease = 1;
        return dot(fits.sharp.linear, fits.sharp.linear) > 0 ? std::make_optional(fits) : std::nullopt;
    }
    const Sums sums = sumsOf(packs, place);
    if (!(sums.weight > 0) || !(dot(sums.n, sums.n) > 0)) return {};
    if (options.kind == PointSetKind::AdamsonAlexa) {
        fits.smooth = planeOf(sums);
        return fits;
    }
    fits.smooth = sphereOf(sums);
    if (!options.sharp) return fits;
    fits.crease = creaseShare(packs, place, sums, fits.smooth);
    if (fits.crease > 0) fits.sharp = robustPlaneOf(packs, place, spread, options);
    return fits;
}

}  // namespace vdbsynth
