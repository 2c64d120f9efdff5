#include "libvdbsynth/base/hash.h"

#include "libvdbsynth/base/error.h"

#include <xxhash.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <vector>

namespace vdbsynth {
namespace {

std::string hexadecimal(const XXH128_hash_t& hash) {
    char text[33];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                  static_cast<unsigned long long>(hash.low64));
    return text;
}

}  // namespace

std::string contentHash(const void* data, std::size_t bytes) {
    return hexadecimal(XXH3_128bits(data, bytes));
}

std::string fileHash(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw Error(ErrorCode::Io, path + ": cannot be read");
    const std::unique_ptr<XXH3_state_t, void (*)(XXH3_state_t*)> state(
        XXH3_createState(), [](XXH3_state_t* s) { XXH3_freeState(s); });
    XXH3_128bits_reset(state.get());
    std::vector<char> buffer(1 << 20);
    while (file) {
        file.read(buffer.data(), std::streamsize(buffer.size()));
        XXH3_128bits_update(state.get(), buffer.data(), std::size_t(file.gcount()));
    }
    if (file.bad()) throw Error(ErrorCode::Io, path + ": reading failed");
    return hexadecimal(XXH3_128bits_digest(state.get()));
}

std::uint64_t hash64(const void* data, std::size_t bytes, std::uint64_t seed) noexcept {
    return XXH3_64bits_withSeed(data, bytes, seed);
}

}  // namespace vdbsynth
