#include "telemetry/files/mapped_file.h"

#include "base/error.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace flightwatt::telemetry {
namespace {

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

}  // namespace flightwatt::telemetry
