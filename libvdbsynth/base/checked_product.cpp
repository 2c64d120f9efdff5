#include "libvdbsynth/base/checked_product.h"

#include <limits>

namespace vdbsynth {

std::optional<std::int64_t> checkedProduct(std::initializer_list<std::int64_t> factors) {
    bool zero = false;
    for (std::int64_t factor : factors) {
        if (factor < 0) return std::nullopt;
        zero = zero || factor == 0;
    }
    if (zero) return 0;
    std::int64_t product = 1;
    for (std::int64_t factor : factors) {
        if (product > std::numeric_limits<std::int64_t>::max() / factor) return std::nullopt;
        product *= factor;
    }
    return product;
}

bool productFits(std::initializer_list<std::int64_t> factors, std::uint64_t most) {
    const std::optional<std::int64_t> product = checkedProduct(factors);
    return product && std::uint64_t(*product) <= most;
}

}  // namespace vdbsynth
