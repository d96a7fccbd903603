#include "telemetry/data_file.h"

#include "base/error.h"
#include "telemetry/files/decompression.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace flightwatt::telemetry {
namespace {

using namespace std::string_view_literals;

void refuse_what_is_no_file(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) throw InputError({path.string()}, "does not exist");
    if (error) throw InputError({path.string()}, fmt::format("cannot be read: {}", error.message()));
    if (std::filesystem::is_directory(status)) {
        throw InputError({path.string()}, "is a folder, expected a Paparazzi .data file");
    }
    if (!std::filesystem::is_regular_file(status)) throw InputError({path.string()}, "is not a regular file");
}

/// Bytes of the file that were never written and read as zeros, as far as its file system tells: those between its
/// parts.
std::size_t unwritten_bytes(const InputFile& file) {
    constexpr int max_parts = 1000;  // of a file in more parts, those of the others
    std::size_t unwritten = 0;
    off_t at = 0;
    const auto size = static_cast<off_t>(file.size());
    for (int part = 0; part < max_parts && at < size; ++part) {
        auto written = ::lseek(file.descriptor(), at, SEEK_DATA);
        if (written < 0 && errno != ENXIO) break;  // it cannot tell
        if (written < 0) written = size;           // nothing behind it
        unwritten += static_cast<std::size_t>(written - at);
        at = written < size ? ::lseek(file.descriptor(), written, SEEK_HOLE) : size;
        if (at < written) break;
    }
    return unwritten;
}

std::string size_text(std::size_t bytes) {
    const auto size = static_cast<double>(bytes);
    return bytes < 1'000'000'000 ? fmt::format("{:.3g} MB", size / 1e6) : fmt::format("{:.3g} GB", size / 1e9);
}

void reject_unwritten(const InputFile& file, std::size_t max_bytes) {
    const auto unwritten = unwritten_bytes(file);
    if (unwritten <= max_bytes) return;
    throw InputError(
        {file.path().string()},
        fmt::format("{} of its {} were never written and are zeros", size_text(unwritten), size_text(file.size())),
        "expected a telemetry log");
}

}  // namespace

DataFile::DataFile(const std::filesystem::path& path, std::size_t max_bytes) {
    refuse_what_is_no_file(path);
    file_.emplace(path);
    if (file_->size() == 0) {
        throw InputError({path.string()}, "is empty, expected telemetry lines: TIME SENDER NAME FIELD ...");
    }
    reject_unwritten(*file_, max_bytes);
    mapped_.emplace(*file_);
    text_ = mapped_->text();
    if (text_.starts_with("PK\x03\x04"sv)) {
        throw InputError({path.string()}, "is a ZIP archive", "unpack it, or compress with gzip, xz or zstd");
    }
    try {
        auto text = decompressed(text_, path, max_bytes);
        if (!text) return;
        decompressed_ = std::move(*text);
    } catch (const InputError&) {
        require_unchanged();
        throw;
    }
    require_unchanged();
    mapped_.reset();
    file_.reset();
    text_ = decompressed_;
    if (text_.empty()) throw InputError({path.string()}, "is empty once decompressed");
}

void DataFile::require_unchanged() const {
    if (!file_) return;
    file_->require_not_truncated();
    if (mapped_->is_damaged()) {
        throw InputError({file_->path().string()},
                         "could not be read to its end: it was cut meanwhile, or the disk failed",
                         "run again when it is whole");
    }
}

}  // namespace flightwatt::telemetry
