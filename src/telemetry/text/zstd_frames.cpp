#include "telemetry/text/zstd_frames.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace flightwatt::telemetry {
namespace {

constexpr std::uint64_t frame_magic = 0xFD2FB528;
constexpr std::uint64_t skippable_magic = 0x184D2A50;  ///< its last four bits are free

/// Takes little-endian numbers off the front; `cut_off` once there were too few bytes.
struct ByteReader {
    std::string_view bytes;
    bool cut_off = false;

    std::uint64_t number(std::size_t size) {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < size && i < bytes.size(); ++i) {
            value |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
        }
        skip(size);
        return value;
    }
    void skip(std::uint64_t size) {
        cut_off = cut_off || size > bytes.size();
        bytes.remove_prefix(cut_off ? bytes.size() : size);
    }
};

void skip_frame(ByteReader& reader) {
    const auto descriptor = reader.number(1);
    const bool single_segment = (descriptor >> 5 & 1) != 0;
    constexpr std::array<std::size_t, 4> dictionary_size{0, 1, 2, 4};
    const std::array<std::size_t, 4> content_size{single_segment ? 1U : 0U, 2, 4, 8};
    reader.skip((single_segment ? 0 : 1) + dictionary_size[descriptor & 3] + content_size[descriptor >> 6]);
    for (bool last = false; !last && !reader.cut_off;) {
        const auto block = reader.number(3);
        last = (block & 1) != 0;
        const bool repeats_one_byte = (block >> 1 & 3) == 1;
        reader.skip(repeats_one_byte ? 1 : block >> 3);
    }
    const bool checksum = (descriptor >> 2 & 1) != 0;
    reader.skip(checksum ? 4 : 0);
}

}  // namespace

bool holds_whole_zstd_frames(std::string_view bytes) {
    ByteReader reader{bytes};
    while (!reader.bytes.empty()) {
        const auto magic = reader.number(4);
        if (magic == frame_magic)
            skip_frame(reader);
        else if ((magic & ~std::uint64_t{0xF}) == skippable_magic)
            reader.skip(reader.number(4));
        else
            return false;
    }
    return !reader.cut_off;
}

}  // namespace flightwatt::telemetry
