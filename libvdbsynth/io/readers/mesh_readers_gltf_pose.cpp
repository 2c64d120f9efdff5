// The default pose of a glTF mesh: morph targets by their weights, then joints of a skin.
#include "libvdbsynth/io/readers/mesh_readers_gltf_steps.h"

#include <algorithm>

namespace vdbsynth {
namespace {

// Four joints each; programs write one or two.
constexpr std::size_t kMostSets = 16;

}  // namespace

void moveByTargets(const GltfFile& file, const GltfJson& primitive, const std::vector<double>& weights,
                   GltfValues& places) {
    const GltfJson* targets = gltfMember(primitive, "targets");
    if (!targets || !targets->is_array()) return;
    for (std::size_t i = 0; i < std::min(weights.size(), targets->size()); ++i) {
        const std::int64_t accessor = file.index((*targets)[i], "POSITION");
        if (weights[i] == 0 || accessor < 0) continue;
        const GltfValues steps = gltfValues(file, accessor);
        if (steps.width != 3 || steps.count != places.count)
            file.refuse("a morph target has " + std::to_string(steps.count) + " positions for " +
                        std::to_string(places.count) + " vertices");
        for (std::size_t k = 0; k < places.numbers.size(); ++k)
            places.numbers[k] += weights[i] * steps.numbers[k];
    }
}

GltfSkin::GltfSkin(const GltfFile& file, const GltfScene& scene, std::int64_t index) : mFile(file) {
    const GltfJson& skin = file.item("skins", index, "a skin");
    const std::vector<std::int64_t> joints = file.indices(skin, "joints");
    GltfValues binds;
    const std::int64_t accessor = file.index(skin, "inverseBindMatrices");
    if (accessor >= 0) binds = gltfValues(file, accessor);
    if (accessor >= 0 && (binds.width != 16 || binds.count < joints.size()))
        file.refuse("a skin has " + std::to_string(joints.size()) + " joints and " +
                    std::to_string(binds.width == 16 ? binds.count : 0) + " inverse bind matrices");
    for (std::size_t i = 0; i < joints.size(); ++i) {
        Affine bind = kIdentity;
        if (accessor >= 0) std::copy_n(binds.numbers.begin() + std::ptrdiff_t(i * 16), 16, bind.begin());
        mJoints.push_back(multiplied(scene.globalOf(joints[i]), bind));
    }
}

// The mean of the joints' matrices by a vertex's weights.
Affine GltfSkin::blended(const std::vector<GltfValues>& joints, const std::vector<GltfValues>& weights,
                         std::size_t vertex) {
    Affine sum{};
    double whole = 0;
    const auto matrixOf = [&](double joint) -> const Affine& {
        if (!(joint >= 0) || joint >= double(mJoints.size()))
            mFile.refuse("a vertex follows a joint that its skin does not have");
        return mJoints[std::size_t(joint)];
    };
    for (std::size_t set = 0; set < joints.size(); ++set)
        for (std::size_t k = vertex * 4; k < vertex * 4 + 4; ++k) {
            const double weight = weights[set].numbers[k];
            if (!(weight > 0)) continue;
            const Affine& joint = matrixOf(joints[set].numbers[k]);
            for (std::size_t m = 0; m < 16; ++m) sum[m] += weight * joint[m];
            whole += weight;
        }
    if (!(whole > 0)) {
        ++mUnweighted;
        return matrixOf(joints[0].numbers[vertex * 4]);
    }
    for (double& value : sum) value /= whole;
    return sum;
}

bool GltfSkin::moves(const GltfJson& primitive) const {
    const GltfJson* attributes = gltfMember(primitive, "attributes");
    return attributes && mFile.index(*attributes, "JOINTS_0") >= 0 &&
           mFile.index(*attributes, "WEIGHTS_0") >= 0;
}

bool GltfSkin::move(const GltfJson& primitive, GltfValues& places) {
    const GltfJson* attributes = gltfMember(primitive, "attributes");
    std::vector<GltfValues> joints, weights;
    for (std::size_t set = 0; attributes; ++set) {
        const std::string number = std::to_string(set);
        const std::int64_t joint = mFile.index(*attributes, ("JOINTS_" + number).c_str()),
                           weight = mFile.index(*attributes, ("WEIGHTS_" + number).c_str());
        if (joint < 0 || weight < 0) break;
        if (set == kMostSets) mFile.refuse("a mesh has over " + number + " sets of joints");
        joints.push_back(gltfValues(mFile, joint));
        weights.push_back(gltfValues(mFile, weight));
        for (const GltfValues* values : {&joints.back(), &weights.back()})
            if (values->width != 4 || values->count != places.count)
                mFile.refuse("joints or weights are not vectors of four, one for each vertex");
    }
    std::size_t mirrored = 0;
    for (std::size_t i = 0; i < places.count; ++i) {
        const Affine matrix = blended(joints, weights, i);
        mirrored += determinant(matrix) < 0;
        double* place = &places.numbers[3 * i];
        const Vec3d moved = transformed(matrix, {place[0], place[1], place[2]});
        for (int axis = 0; axis < 3; ++axis) place[axis] = moved[axis];
    }
    return 2 * mirrored > places.count;
}

}  // namespace vdbsynth
