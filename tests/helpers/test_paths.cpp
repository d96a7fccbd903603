#include "helpers/test_paths.h"

#include <cstdlib>
#include <string>

namespace flightwatt::test {

// The only file that knows where the project is: the others are compiled the same in every clone.
std::filesystem::path source_dir() { return FLIGHTWATT_SOURCE_DIR; }

std::filesystem::path binary_dir() { return FLIGHTWATT_BINARY_DIR; }

std::filesystem::path hazards_dir() { return binary_dir() / "hazards"; }

std::filesystem::path programs_dir() {
    const char* const named = std::getenv("FLIGHTWATT_PROGRAMS");
    return named != nullptr ? std::filesystem::path(named) : binary_dir() / "bin";
}

std::filesystem::path shared_dir() {
    const auto folder = source_dir().parent_path() / "shared";
    return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

std::filesystem::path scratch_dir() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "." + test->name();
    for (auto& c : name) {
        if (c == '/') c = '_';
    }
    auto folder = binary_dir() / "scratch" / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

}  // namespace flightwatt::test
