#include "telemetry/files/decompression.h"

#include "base/error.h"

#include <array>
#include <cstdint>
#include <new>
#include <stdexcept>

#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <boost/iostreams/read.hpp>
#include <fmt/format.h>

namespace flightwatt::telemetry {
namespace {

namespace io = boost::iostreams;
using namespace std::string_view_literals;

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

/// Whether `bytes` are whole zstd frames (RFC 8878, section 3.1): Boost's decompressor takes a frame that is
/// cut off for the end of the file.
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

/// Adds the decompressor that the first bytes ask for; false for plain text.
bool push_decompressor(std::string_view bytes, io::filtering_istream& stream) {
    if (bytes.starts_with("\x1F\x8B"sv))
        stream.push(io::gzip_decompressor());
    else if (bytes.starts_with("BZh"sv))
        stream.push(io::bzip2_decompressor());
    else if (bytes.starts_with("\xFD"
                               "7zXZ\0"sv))
        stream.push(io::lzma_decompressor());
    else if (bytes.starts_with("\x28\xB5\x2F\xFD"sv)) {
        if (!holds_whole_zstd_frames(bytes)) throw std::runtime_error("a zstd frame is cut off");
        stream.push(io::zstd_decompressor());
    } else
        return false;
    return true;
}

void require_at_most(std::size_t max_bytes, std::size_t bytes, const std::filesystem::path& file) {
    if (bytes <= max_bytes) return;
    throw InputError({file.string()},
                     fmt::format("unpacks to more than {:.4g} MB", static_cast<double>(max_bytes) / 1e6),
                     "if it is a log all the same, --max-log-mb raises the limit");
}

}  // namespace

std::optional<std::string> decompressed(std::string_view bytes, const std::filesystem::path& file,
                                        std::size_t max_bytes) {
    constexpr std::streamsize step = 1 << 16;
    std::string text;
    try {
        io::filtering_istream stream;
        if (!push_decompressor(bytes, stream)) return std::nullopt;
        stream.push(io::array_source(bytes.data(), bytes.size()));
        std::array<char, step> part{};
        for (auto count = io::read(stream, part.data(), step); count > 0; count = io::read(stream, part.data(), step)) {
            text.append(part.data(), static_cast<std::size_t>(count));
            require_at_most(max_bytes, text.size(), file);
        }
        return text;
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError({file.string()}, fmt::format("cannot be decompressed: {}", error.what()),
                         "is the file whole?");
    }
}

}  // namespace flightwatt::telemetry
