#include "report/sections/blocks.h"

#include "base/csv.h"
#include "base/number.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/filter/zlib.hpp>
#include <boost/iostreams/filtering_stream.hpp>

namespace flightwatt::report {
namespace {

std::string deflated(std::string_view text) {
    namespace io = boost::iostreams;
    constexpr int level = 4;  // two thirds of the time of 6, 4 % more bytes
    std::string bytes;
    io::filtering_ostream stream;
    stream.push(io::zlib_compressor(io::zlib_params(level)));
    stream.push(io::back_inserter(bytes));
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.reset();  // flushes
    return bytes;
}

std::string base64(const std::string& bytes) {
    using namespace boost::archive::iterators;
    using Digits = base64_from_binary<transform_width<std::string::const_iterator, 6, 8>>;
    std::string text(Digits(bytes.begin()), Digits(bytes.end()));
    constexpr std::size_t digits_of_three_bytes = 4;
    while (text.size() % digits_of_three_bytes != 0) text += '=';
    return text;
}

/// [name, decimals, steps].
VegaJson packed_numbers(const std::string& name, const std::vector<std::string>& cells) {
    std::size_t decimals = 0;
    for (const auto& cell : cells)
        if (const auto point = cell.find('.'); point != std::string::npos && cell.find('e') == std::string::npos)
            decimals = std::max(decimals, cell.size() - point - 1);
    const double scale = std::pow(10.0, static_cast<double>(decimals));
    VegaJson::array_t steps;
    std::int64_t last = 0;
    for (const auto& cell : cells) {
        const auto number = parse_number(cell);
        if (!number) {
            steps.emplace_back(nullptr);
            continue;
        }
        const auto now = std::llround(*number * scale);
        steps.emplace_back(now - last);
        last = now;
    }
    return VegaJson::array_t{name, decimals, steps};
}

VegaJson packed_table(const std::string& csv, const VegaJson& parse) {
    std::vector<std::string> names;
    std::vector<std::vector<std::string>> columns;
    for_each_csv_row(csv, "a figure's table", [&](const CsvRowView& row) {
        columns.resize(row.cells.size());
        for (std::size_t c = 0; c < columns.size(); ++c)
            (names.size() < columns.size() ? names : columns[c]).emplace_back(row.cells[c].text);
    });
    auto packed = VegaJson::array();
    for (std::size_t c = 0; c < columns.size(); ++c)
        packed.push_back(parse.contains(names[c]) ? packed_numbers(names[c], columns[c])
                                                  : VegaJson(VegaJson::array_t{names[c], columns[c]}));
    return {{"packed", std::move(packed)}};
}

}  // namespace

std::string compressed_block(std::string_view html) { return base64(deflated(html)); }

VegaJson packed_tables(VegaJson spec) {
    if (!spec.is_structured()) return spec;
    if (spec.is_object() && spec.contains("format") && spec.contains("values"))  // FigureData::json()
        return packed_table(spec["values"].get_ref<const std::string&>(), spec["format"]["parse"]);
    for (auto& part : spec) part = packed_tables(std::move(part));
    return spec;
}

}  // namespace flightwatt::report
