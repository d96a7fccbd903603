#include "telemetry/text/row_storage.h"

#include <algorithm>
#include <memory>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace flightwatt::telemetry {
namespace {

/// Asks for large pages behind a long column: faulting it in page by page would take longer than to fill it.
void use_large_pages([[maybe_unused]] std::vector<double>& column) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr std::size_t large_page = 2u << 20;
    void* first = column.data();
    std::size_t bytes = column.capacity() * sizeof(double);
    if (std::align(large_page, large_page, first, bytes) == nullptr) return;
    // Only advice: without it everything works, more slowly.
    ::madvise(first, bytes / large_page * large_page, MADV_HUGEPAGE);
#endif
}

}  // namespace

std::size_t rows_to_reserve(std::size_t rows, std::size_t bytes_read, std::size_t text_size) {
    constexpr std::size_t too_few_for_a_rate = 1000;
    if (rows < too_few_for_a_rate) return std::max<std::size_t>(64, 2 * rows);
    const double promised = static_cast<double>(rows) * static_cast<double>(text_size) /
                            static_cast<double>(std::max<std::size_t>(bytes_read, 1));
    return std::max(static_cast<std::size_t>(1.1 * promised), rows + rows / 2);
}

void reserve_rows(MessageTable& table, std::size_t rows) {
    const auto reserve = [&](std::vector<double>& column) {
        column.reserve(rows);
        use_large_pages(column);
    };
    reserve(table.time_s);
    for (auto& column : table.columns) reserve(column.values);
}

}  // namespace flightwatt::telemetry
