#pragma once
#include "libvdbsynth/math/vec3.h"

namespace vdbsynth {

/// The sum of squared distances to planes [garland1997], as dual contouring
/// minimises it [ju2002, section 2.1].
class Quadric {
public:
    /// A plane through a point, its normal of unit length.
    void add(const Vec3d& normal, const Vec3d& point, double weight = 1);
    void add(const Quadric& other);
    /// The normal of the best-fitting plane: along it the sum grows fastest. Its sign is arbitrary.
    Vec3d mainNormal() const;
    bool empty() const { return mWeight == 0; }

    struct Minimum {
        Vec3d point;
        int rank = 0;  ///< of the planes: 1 flat, 2 on an edge, 3 in a corner
    };
    /// The minimiser nearest to `start`: a direction in which the planes differ too little keeps the start's
    /// coordinate. The start if no plane was added.
    /// @param edgeCut, cornerCut  least ratio of the second and third eigenvalue to the first to count
    Minimum minimum(const Vec3d& start, double edgeCut = 0.02, double cornerCut = 0.02) const;

private:
    double mMatrix[6] = {};  // xx xy xz yy yz zz of the sum of n n^T
    Vec3d mVector;           // sum of n (n . p)
    double mWeight = 0;
};

}  // namespace vdbsynth
