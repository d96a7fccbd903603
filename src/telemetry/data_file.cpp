#include "telemetry/data_file.h"

#include "base/error.h"
#include "base/input_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <boost/iostreams/read.hpp>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>
#include <zstd.h>

namespace flightwatt::telemetry {
namespace {

namespace io = boost::iostreams;
using namespace std::string_view_literals;

/// Whether `bytes` are complete zstd frames: Boost's decompressor does not report a frame that is cut off.
bool holds_whole_zstd_frames(std::string_view bytes) {
    while (!bytes.empty()) {
        const auto size = ZSTD_findFrameCompressedSize(bytes.data(), bytes.size());
        if (ZSTD_isError(size) != 0) return false;
        bytes.remove_prefix(size);
    }
    return true;
}

/// Adds the decompressor for the format of the first bytes; false for plain text.
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
                     "if it is a log, --max-log-mb raises the limit");
}

/// The unpacked bytes of gzip, bzip2, xz or zstd, recognised by the first bytes; std::nullopt for anything else. Throws
/// InputError, naming `file`, for broken compression and as soon as there are more than `max_bytes`.
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
                         "is the file complete?");
    }
}

void require_regular_file(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) return;  // InputFile reports it
    if (error) throw InputError({path.string()}, fmt::format("cannot be read: {}", error.message()));
    if (!std::filesystem::is_directory(status) && !std::filesystem::is_regular_file(status))
        throw InputError({path.string()}, "is not a regular file");
}

/// Asks the kernel for pages of 2 MB: of a large log, giving out those of 4 kB takes longer than parsing it.
void use_large_pages(const std::string& reserved) {
    constexpr std::size_t page = std::size_t{1} << 21;
    void* begin = const_cast<char*>(reserved.data());  // NOLINT(cppcoreguidelines-pro-type-const-cast): no write
    std::size_t space = reserved.capacity();
    if (std::align(page, page, begin, space) != nullptr) ::madvise(begin, space / page * page, MADV_HUGEPAGE);
}

/// The bytes that the file had when it was opened. Throws InputError for more than `max_zeros` bytes in blocks of
/// zeros: a sparse file can be larger than any memory.
std::string read_bytes(const InputFile& file, std::size_t max_zeros) {
    constexpr std::size_t block = 1 << 16;
    constexpr std::size_t max_reserved = 1 << 30;
    std::string bytes;
    bytes.reserve(std::min(file.size(), max_reserved));
    use_large_pages(bytes);
    std::size_t zeros = 0;
    while (bytes.size() < file.size()) {
        const auto begin = bytes.size();
        bytes.resize(std::min(begin + block, file.size()));
        const auto count = ::read(file.descriptor(), bytes.data() + begin, bytes.size() - begin);
        if (count < 0)
            throw InputError({file.path().string()}, fmt::format("cannot be read: {}", std::strerror(errno)));
        bytes.resize(begin + static_cast<std::size_t>(count));
        if (count == 0) break;
        if (bytes.find_first_not_of('\0', begin) == std::string::npos) zeros += static_cast<std::size_t>(count);
        if (zeros > max_zeros) {
            throw InputError({file.path().string()},
                             fmt::format("has more than {:.4g} MB of zeros", static_cast<double>(max_zeros) / 1e6),
                             "expected a telemetry log");
        }
    }
    file.require_not_truncated();
    return bytes;
}

}  // namespace

std::string read_data_file(const std::filesystem::path& path, std::size_t max_bytes) {
    require_regular_file(path);
    auto bytes = read_bytes(InputFile(path), max_bytes);
    if (bytes.empty()) {
        throw InputError({path.string()}, "is empty, expected a log", "nothing was logged, or it was not copied");
    }
    if (bytes.starts_with("PK\x03\x04"sv)) {
        throw InputError({path.string()}, "is a ZIP archive", "unpack it, or compress with gzip, xz or zstd");
    }
    auto text = decompressed(bytes, path, max_bytes);
    if (!text) return bytes;
    if (text->empty()) throw InputError({path.string()}, "is empty once decompressed");
    return std::move(*text);
}

std::string beginning_of_file(const std::filesystem::path& path) {
    constexpr std::size_t size = 1 << 16;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return "";  // a pipe would wait
    std::ifstream file(path, std::ios::binary);
    std::string bytes(size, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    return bytes;
}

}  // namespace flightwatt::telemetry
