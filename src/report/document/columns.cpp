#include "report/document/columns.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/filter/zlib.hpp>
#include <boost/iostreams/filtering_stream.hpp>

namespace flightwatt::report {

Json rounded_json(double value, int decimals) {
    if (!std::isfinite(value)) return nullptr;
    const double scale = std::pow(10.0, decimals);
    return std::round(value * scale) / scale + 0.0;  // never -0
}

Json rounded_column(const std::vector<double>& values, int decimals) {
    Json::array_t column;
    column.reserve(values.size());
    for (const double value : values) column.push_back(rounded_json(value, decimals));
    return column;
}

Json column_of(const std::vector<double>& values) {
    constexpr int digits = 6;
    Json::array_t column;
    column.reserve(values.size());
    for (const double value : values) {
        const bool has_digits = value != 0.0 && std::isfinite(value);
        const int before_point = has_digits ? static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1 : 1;
        column.push_back(rounded_json(value, digits - before_point));
    }
    return column;
}

std::vector<std::size_t> downsample_m4(const std::vector<double>& time_s, const std::vector<double>& values,
                                       std::size_t columns) {
    constexpr std::size_t rows_per_column = 4;
    std::vector<std::size_t> rows(time_s.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    if (rows.size() <= rows_per_column * columns) return rows;
    const double duration_s = time_s.back() - time_s.front();
    const auto column_of = [&](std::size_t i) {
        const double part = (time_s[i] - time_s.front()) / duration_s;
        return std::min(columns - 1, static_cast<std::size_t>(part * static_cast<double>(columns)));
    };
    std::vector<std::size_t> kept;
    for (auto first = rows.begin(); first != rows.end();) {
        const auto end =
            std::find_if(first, rows.end(), [&](std::size_t i) { return column_of(i) != column_of(*first); });
        const auto [min_at, max_at] =
            std::minmax_element(first, end, [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
        std::vector<std::size_t> chosen{*first, *min_at, *max_at, *std::prev(end)};
        std::ranges::sort(chosen);
        std::ranges::unique_copy(chosen, std::back_inserter(kept));
        first = end;
    }
    return kept;
}

std::string deflated_base64(std::string_view text) {
    namespace io = boost::iostreams;
    constexpr int level = 4;  // two thirds of the time of 6, 4 % more bytes
    std::string bytes;
    io::filtering_ostream stream;
    stream.push(io::zlib_compressor(io::zlib_params(level)));
    stream.push(io::back_inserter(bytes));
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.reset();  // flushes
    return base64(bytes);
}

std::string base64(const std::string& bytes) {
    using namespace boost::archive::iterators;
    using Digits = base64_from_binary<transform_width<std::string::const_iterator, 6, 8>>;
    std::string base64(Digits(bytes.begin()), Digits(bytes.end()));
    constexpr std::size_t digits_of_three_bytes = 4;
    while (base64.size() % digits_of_three_bytes != 0) base64 += '=';
    return base64;
}

}  // namespace flightwatt::report
