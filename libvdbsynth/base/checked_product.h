#pragma once
#include <cstdint>
#include <initializer_list>
#include <optional>

namespace vdbsynth {

/// The product of counts that a file's header claims, for sizes of buffers and files. It never wraps around.
/// @return nothing if a factor is negative or the product is over 2^63 - 1
std::optional<std::int64_t> checkedProduct(std::initializer_list<std::int64_t> factors);

/// True if no factor is negative and their product is at most `most`: the header's claim fits the file.
bool productFits(std::initializer_list<std::int64_t> factors, std::uint64_t most);

}  // namespace vdbsynth
