// What all fuzz targets share: libFuzzer's entry.

#include "fuzz/fuzz_target.h"

#include "base/error.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include <unistd.h>

namespace flightwatt::fuzz {
namespace {

/// In memory, where there is such a folder; absent at the end.
struct Folder {
    std::filesystem::path path;

    Folder() {
        const bool has_memory = std::filesystem::is_directory("/dev/shm");
        path =
            std::filesystem::path(has_memory ? "/dev/shm" : "/tmp") / ("flightwatt-fuzz-" + std::to_string(::getpid()));
        std::filesystem::create_directories(path);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

}  // namespace

std::filesystem::path as_file(std::string_view bytes, const char* name) {
    static const Folder folder;
    auto path = folder.path / name;
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path;
}

}  // namespace flightwatt::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace flightwatt;
    try {
        fuzz::run({reinterpret_cast<const char*>(data), size});
    } catch (const InputError&) {
    } catch (const UsageError&) {
    } catch (const NoResultError&) {
    }
    return 0;
}
