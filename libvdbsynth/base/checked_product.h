#pragma once
#include <cstdint>
#include <initializer_list>
#include <optional>

namespace vdbsynth {

/// The product of counts that a file's header claims, for sizes of buffers and files. It never wraps.
/// @return nothing where a factor is negative or the product is over 2^63 - 1
std::optional<std::int64_t> checkedProduct(std::initializer_list<std::int64_t> factors);

/// True if no factor is negative and their product is at most `most`: what a header claims fits what is
/// there.
bool productFits(std::initializer_list<std::int64_t> factors, std::uint64_t most);

}  // namespace vdbsynth
