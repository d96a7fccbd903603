#include "telemetry/data_file.h"

#include "base/error.h"
#include "telemetry/files/decompression.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

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

}  // namespace

DataFile::DataFile(const std::filesystem::path& path, std::size_t most_bytes) {
    refuse_what_is_no_file(path);
    file_.emplace(path);
    if (file_->size() == 0) {
        throw InputError({path.string()}, "is empty, expected telemetry lines: TIME SENDER NAME FIELD ...");
    }
    mapped_.emplace(*file_);
    text_ = mapped_->text();
    if (text_.starts_with("PK\x03\x04"sv)) {
        throw InputError({path.string()}, "is a ZIP archive", "unpack it, or compress with gzip, xz or zstd");
    }
    try {
        auto text = decompressed(text_, path, most_bytes);
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
    file_->require_uncut();
    if (mapped_->is_damaged()) {
        throw InputError({file_->path().string()},
                         "could not be read to its end: it was cut meanwhile, or the disk failed",
                         "run again when it is whole");
    }
}

}  // namespace flightwatt::telemetry
