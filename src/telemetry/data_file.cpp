#include "telemetry/data_file.h"

#include "base/error.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_stream.hpp>
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

void refuse_what_is_no_file(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw InputError({path.string()}, "does not exist");
    if (std::filesystem::is_directory(status)) {
        throw InputError({path.string()}, "is a folder, expected a Paparazzi .data file");
    }
    if (!std::filesystem::is_regular_file(status)) throw InputError({path.string()}, "is not a regular file");
    if (std::filesystem::file_size(path) == 0) {
        throw InputError({path.string()}, "is empty, expected telemetry lines: TIME SENDER NAME FIELD ...");
    }
}

}  // namespace

DataFile::DataFile(const std::filesystem::path& path) {
    refuse_what_is_no_file(path);
    try {
        mapped_.open(path.string());
    } catch (const std::exception& error) {
        throw InputError({path.string()}, fmt::format("cannot be read: {}", error.what()));
    }
    text_ = {mapped_.data(), mapped_.size()};
    if (text_.starts_with("PK\x03\x04"sv)) {
        throw InputError({path.string()}, "is a ZIP archive", "unpack it, or compress with gzip, xz or zstd");
    }
    try {
        io::filtering_istream stream;
        if (!push_decompressor(text_, stream)) return;
        stream.push(io::array_source(mapped_.data(), mapped_.size()));
        io::copy(stream, io::back_inserter(decompressed_));
    } catch (const std::exception& error) {
        throw InputError({path.string()}, fmt::format("cannot be decompressed: {}", error.what()),
                         "is the file whole?");
    }
    mapped_.close();
    text_ = decompressed_;
    if (text_.empty()) throw InputError({path.string()}, "is empty once decompressed");
}

}  // namespace flightwatt::telemetry
