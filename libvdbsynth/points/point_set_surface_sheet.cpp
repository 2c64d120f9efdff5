#include "libvdbsynth/points/point_set_surface_steps.h"

namespace vdbsynth {
namespace {

typedef float Lanes __attribute__((vector_size(32)));

float sumOf(const Lanes& lanes) {
    return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

// Mean point, and the sum of the normals.
struct Middle {
    Vec3f point, normal;
    float weight = 0;
};

__attribute__((target_clones("avx2", "default"))) Middle middleOf(const std::vector<PointPack>& packs,
                                                                  const Vec3f& place) {
    Lanes sum[7] = {};
    for (const PointPack& pack : packs) {
        const Lanes x = pack.x - place.x, y = pack.y - place.y, z = pack.z - place.z;
        const Lanes beyond = 1 - 4 * (x * x + y * y + z * z) * pack.inverse;
        const Lanes u = beyond > 0 ? beyond : Lanes{};
        const Lanes w = (u * u) * (u * u) * pack.anchors;
        sum[0] += w;
        sum[1] += w * pack.x;
        sum[2] += w * pack.y;
        sum[3] += w * pack.z;
        sum[4] += w * pack.normalX;
        sum[5] += w * pack.normalY;
        sum[6] += w * pack.normalZ;
    }
    Middle middle;
    middle.weight = sumOf(sum[0]);
    middle.point = {sumOf(sum[1]), sumOf(sum[2]), sumOf(sum[3])};
    middle.normal = {sumOf(sum[4]), sumOf(sum[5]), sumOf(sum[6])};
    return middle;
}

__attribute__((target_clones("avx2", "default"))) void share(std::vector<PointPack>& packs,
                                                             const Vec3f& point, const Vec3f& normal,
                                                             float reach) {
    const float scale = 3 / (reach * reach);
    for (PointPack& pack : packs) {
        const Lanes x = pack.normalX + normal.x, y = pack.normalY + normal.y, z = pack.normalZ + normal.z;
        const Lanes off = (pack.x - point.x) * x + (pack.y - point.y) * y + (pack.z - point.z) * z;
        // A normal that is opposite has no share by its facing; the addend keeps the quotient finite.
        const Lanes apart = scale * off * off / (x * x + y * y + z * z + 1e-6f);
        const Lanes cosine = pack.normalX * normal.x + pack.normalY * normal.y + pack.normalZ * normal.z;
        const Lanes near = 1.5f * (1 - apart), facing = 4 * (cosine + 0.5f);  // as sheetShare
        const Lanes one = Lanes{} + 1;
        const Lanes a = near > 0 ? near : Lanes{}, b = facing > 0 ? facing : Lanes{};
        pack.share = pack.rough * (a < one ? a : one) * (b < one ? b : one);
    }
}

}  // namespace

void sharesOfSheet(std::vector<PointPack>& packs, const Vec3f& place, float reach) {
    const Middle middle = middleOf(packs, place);
    if (!(middle.weight > 0) || !(dot(middle.normal, middle.normal) > 0)) {
        // Too far from all points for a middle.
        for (PointPack& pack : packs) pack.share = pack.anchors;
        return;
    }
    share(packs, middle.point * (1 / middle.weight), normalized(middle.normal), reach);
}

}  // namespace vdbsynth
