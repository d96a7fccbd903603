#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "report/sections/sections.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/filter/zlib.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <fmt/format.h>

namespace flightwatt::report {
namespace {

std::string deflated(std::string_view text) {
    namespace io = boost::iostreams;
    constexpr int level = 4;  // two thirds of 6's time, and 4 % more bytes
    std::string bytes;
    io::filtering_ostream stream;
    stream.push(io::zlib_compressor(io::zlib_params(level)));
    stream.push(io::back_inserter(bytes));
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.reset();  // writes what is left
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

constexpr auto table_name = "a figure's table";
constexpr std::size_t max_digits = 15;  ///< that a double keeps, and JavaScript with it

/// A cell of a column of numbers.
struct NumberCell {
    bool is_empty = false;
    double value = 0.0;
    std::size_t whole = 0;  ///< how many digits stand before the point
    std::size_t decimals = 0;
    bool is_decimal = true;  ///< of a sign, digits and a point alone, and no more digits than there may be
};

NumberCell number_cell(const CsvRowView::Cell& cell, std::size_t line) {
    NumberCell number;
    number.is_empty = cell.text.empty();
    if (number.is_empty) return number;
    const auto value = parse_number(cell.text);
    if (!value)
        throw InputError({table_name, line, cell.column}, fmt::format("'{}' is not a finite number", cell.text));
    number.value = *value;
    const auto text = cell.text.substr(cell.text.front() == '-' ? 1 : 0);
    const auto point = text.find('.');
    number.whole = std::min(point, text.size());
    number.decimals = point == std::string_view::npos ? 0 : text.size() - point - 1;
    number.is_decimal =
        number.whole + number.decimals <= max_digits && text.find_first_not_of("0123456789.") == std::string_view::npos;
    return number;
}

/// A column as its cells come in.
class PackedColumn {
  public:
    PackedColumn(std::string_view name, bool are_numbers) : name_(name), are_numbers_(are_numbers) {}

    void add(const CsvRowView::Cell& cell, std::size_t line) {
        if (are_numbers_)
            numbers_.push_back(number_cell(cell, line));
        else
            texts_.emplace_back(cell.text);
    }

    VegaJson json() const {
        if (!are_numbers_) return VegaJson::array_t{name_, texts_};
        std::size_t whole = 0;
        std::size_t decimals = 0;
        for (const auto& number : numbers_) {
            whole = std::max(whole, number.whole);
            decimals = std::max(decimals, number.decimals);
            if (!number.is_decimal) return VegaJson::array_t{name_, values()};
        }
        if (whole + decimals > max_digits) return VegaJson::array_t{name_, values()};
        return VegaJson::array_t{name_, decimals, steps(decimals)};
    }

  private:
    VegaJson::array_t steps(std::size_t decimals) const {
        VegaJson::array_t all;
        all.reserve(numbers_.size());
        const double scale = std::pow(10.0, static_cast<double>(decimals));
        std::int64_t last = 0;
        for (const auto& number : numbers_) {
            if (number.is_empty) {
                all.emplace_back(nullptr);
                continue;
            }
            const auto digits = std::llround(number.value * scale);  // exact: a double keeps max_digits
            all.emplace_back(digits - last);
            last = digits;
        }
        return all;
    }

    VegaJson::array_t values() const {
        VegaJson::array_t all;
        for (const auto& number : numbers_) all.push_back(number.is_empty ? VegaJson() : VegaJson(number.value));
        return all;
    }

    std::string name_;
    bool are_numbers_;
    std::vector<NumberCell> numbers_;
    VegaJson::array_t texts_;
};

VegaJson packed_table(const std::string& csv, const VegaJson& parse) {
    std::vector<PackedColumn> columns;
    for_each_csv_row(csv, table_name, [&](const CsvRowView& row) {
        if (columns.empty()) {
            for (const auto& cell : row.cells) columns.emplace_back(cell.text, parse.contains(cell.text));
            return;
        }
        for (std::size_t c = 0; c < columns.size(); ++c) columns[c].add(row.cells[c], row.line);
    });
    auto packed = VegaJson::array();
    for (const auto& column : columns) packed.push_back(column.json());
    return {{"packed", std::move(packed)}};
}

bool is_csv(const VegaJson& data) {
    return data.contains("values") && data["values"].is_string() && data.contains("format") &&
           data["format"].value("type", "") == "csv";
}

}  // namespace

std::string compressed_block(std::string_view html) { return base64(deflated(html)); }

VegaJson packed_tables(const VegaJson& spec) {
    if (!spec.is_structured()) return spec;
    if (spec.is_object() && is_csv(spec))
        return packed_table(spec["values"].get_ref<const std::string&>(), spec["format"]["parse"]);
    if (spec.is_array()) {
        VegaJson::array_t packed;
        packed.reserve(spec.size());
        for (const auto& part : spec) packed.push_back(packed_tables(part));
        return packed;
    }
    VegaJson::object_t packed;
    packed.reserve(spec.size());
    for (const auto& [key, part] : spec.get_ref<const VegaJson::object_t&>()) packed.emplace(key, packed_tables(part));
    return packed;
}

}  // namespace flightwatt::report
