#include "telemetry/data_file.h"

#include "base/error.h"
#include "telemetry/text/zstd_frames.h"

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
