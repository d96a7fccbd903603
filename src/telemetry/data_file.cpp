#include "telemetry/data_file.h"

#include "base/error.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>
#include <system_error>

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

/// What gzip, bzip2, xz or zstd packed (told by the first bytes); std::nullopt for anything else. `file` is named in
/// errors. Throws InputError for broken compression, and for more than `max_bytes` once they are there: what a small
/// file unpacks to may have no end.
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

constexpr std::uintptr_t taken = 1;  ///< no mapping begins there

/// What the signal handler has to know of a mapping, without locks. `begin` is 0 (free), `taken` (being filled in),
/// or where the mapping begins.
struct Slot {
    std::atomic<std::uintptr_t> begin = 0;
    std::atomic<std::size_t> size = 0;
    std::atomic<bool> is_damaged = false;
};
static_assert(std::atomic<std::uintptr_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

std::array<Slot, MappedFile::max_mapped> slots;
struct sigaction handler_before {};
std::uintptr_t page_size = 0;

/// The mapping that holds `address`. It lives: the thread that asked for the address is reading it. Of a slot that
/// changes hands meanwhile the begin differs, or the mapping is another one, elsewhere.
Slot* slot_of(std::uintptr_t address) {
    for (auto& slot : slots) {
        const auto begin = slot.begin.load();
        const auto size = slot.size.load();
        if (begin > taken && address >= begin && address - begin < size && slot.begin.load() == begin) return &slot;
    }
    return nullptr;
}

/// A page of a mapping is not there: zeros take its place and that of all behind it. Anything else that this signal
/// means comes again, to whoever handled it before: a fault by itself, what was sent is sent on.
void on_bus_error(int signal, siginfo_t* info, void* /*context*/) {
    const int error_before = errno;
    const auto address = reinterpret_cast<std::uintptr_t>(info->si_addr);
    auto* const slot = info->si_code == BUS_ADRERR ? slot_of(address) : nullptr;
    if (slot != nullptr) {
        const auto before = address & (page_size - 1);
        const auto rest = slot->begin.load() + slot->size.load() - (address - before);
        if (::mmap(static_cast<char*>(info->si_addr) - before, rest, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED,
                   -1, 0) != MAP_FAILED) {
            slot->is_damaged = true;
            errno = error_before;
            return;
        }
    }
    ::sigaction(signal, &handler_before, nullptr);
    if (info->si_code <= 0) ::raise(signal);
    errno = error_before;
}

/// Once in the program.
bool handle_bus_errors() {
    page_size = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    struct sigaction action {};
    action.sa_sigaction = on_bus_error;
    action.sa_flags = SA_SIGINFO;
    sigemptyset(&action.sa_mask);
    return ::sigaction(SIGBUS, &action, &handler_before) == 0;
}

std::size_t take_slot(const InputFile& file) {
    for (std::size_t i = 0; i < slots.size(); ++i) {
        std::uintptr_t free = 0;
        if (slots[i].begin.compare_exchange_strong(free, taken)) return i;
    }
    throw InputError({file.path().string()}, fmt::format("is one of more than {} logs at a time", slots.size()));
}

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

MappedFile::MappedFile(const InputFile& file) {
    [[maybe_unused]] static const bool handled = handle_bus_errors();
    slot_ = take_slot(file);
    auto& slot = slots[slot_];
    void* const begin = ::mmap(nullptr, file.size(), PROT_READ, MAP_PRIVATE, file.descriptor(), 0);
    if (begin == MAP_FAILED) {
        const int error = errno;
        slot.begin = 0;
        throw InputError({file.path().string()}, fmt::format("cannot be mapped: {}", std::strerror(error)));
    }
    text_ = {static_cast<const char*>(begin), file.size()};
    slot.is_damaged = false;
    slot.size = file.size();
    slot.begin = reinterpret_cast<std::uintptr_t>(begin);
}

MappedFile::~MappedFile() {
    slots[slot_].begin = 0;
    ::munmap(const_cast<char*>(text_.data()), text_.size());
}

bool MappedFile::is_damaged() const { return slots[slot_].is_damaged; }

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
