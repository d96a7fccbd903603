#include "telemetry/autopilot/dataflash.h"

#include "base/number.h"
#include "telemetry/binary/wire_value.h"
#include "telemetry/text/lines.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace flightwatt::telemetry {
namespace {

constexpr std::string_view header = "\xA3\x95";
constexpr std::size_t header_bytes = 3;
constexpr std::uint8_t format_type = 128;
constexpr std::size_t format_bytes = 89;
constexpr double ms_per_s = 1e3;
constexpr std::string_view clock_of_sdlog2 = "TIME";
constexpr std::string_view clock_of_oldest = "GPS";  // before 3.1

/// Type of a field by its letter; a text has many characters.
struct FieldLetters {
    std::string_view letters;
    WireType type;
    std::size_t elements = 1;
};

constexpr FieldLetters field_letters[] = {
    {"b", WireType::int8},      {"BM", WireType::uint8},  {"hc", WireType::int16},  {"HC", WireType::uint16},
    {"ieL", WireType::int32},   {"IE", WireType::uint32}, {"q", WireType::int64},   {"Q", WireType::uint64},
    {"f", WireType::float32},   {"d", WireType::float64}, {"n", WireType::text, 4}, {"N", WireType::text, 16},
    {"Za", WireType::text, 64}, {"g", WireType::text, 2},  // arrays and half floats are not read as numbers
};

double factor_of(char letter) {
    if (letter == 'L') return 1e-7;
    return std::string_view("cCeE").find(letter) == std::string_view::npos ? 1.0 : 0.01;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
    return text;
}

/// A type of message, as FMT defines it.
struct DataflashFormat : LoggedMessage {
    bool is_usable = false;  ///< the fields fill the length
    std::string letters = {};
    std::string columns = {};

    bool ends_in_text() const { return !fields.empty() && fields.back().type == WireType::text; }
};

DataflashFormat make_format(std::string_view name, std::size_t length, std::string_view letters,
                            std::string_view columns) {
    DataflashFormat format;
    format.name = name;
    format.bytes = length;
    format.letters = letters;
    format.columns = columns;
    std::size_t offset = header_bytes;
    const auto is_name = [](char c) { return c > ' ' && c <= '~'; };
    bool is_known = !name.empty() && std::ranges::all_of(name, is_name);
    for (const char letter : letters) {
        const auto* const found = std::ranges::find_if(field_letters, [&](const FieldLetters& known) {
            return known.letters.find(letter) < known.letters.size();
        });
        is_known = is_known && found != std::end(field_letters) && !columns.empty();
        if (!is_known) break;
        format.fields.push_back(
            {std::string(trimmed(take_word(columns, ','))), offset, found->type, factor_of(letter)});
        offset += found->elements * size_of(found->type);
    }
    format.is_usable = is_known && offset == length && columns.empty();
    constexpr double us_per_s = 1e6;
    const bool is_sdlog2 = name == clock_of_sdlog2;
    for (const auto& [column, ticks] : {std::pair{is_sdlog2 ? "StartTime" : "TimeUS", us_per_s},
                                        {name.starts_with("GPS") ? "T" : "TimeMS", ms_per_s}}) {
        if (format.clock) break;
        format.clock = format.index_of(column);
        format.ticks_per_s = ticks;
    }
    format.is_clock = is_sdlog2 || (name == clock_of_oldest && !format.clock);
    return format;
}

/// One message: the bytes with the header, or the values of a line.
struct DataflashMessage {
    const DataflashFormat& format;
    std::string_view bytes;
    const std::vector<std::string_view>* words = nullptr;

    double number(std::size_t field) const {
        return words != nullptr ? number_or_nan((*words)[field]) : format.fields[field].number(bytes);
    }
    /// NaN for a text, and for a field that the format lacks.
    double number(std::string_view field) const {
        const auto index = format.index_of(field);
        return index ? number(*index) : std::numeric_limits<double>::quiet_NaN();
    }
    std::string_view text(std::string_view field) const {
        const auto index = format.index_of(field);
        if (!index) return {};
        if (words != nullptr) return (*words)[*index];
        const auto from = bytes.substr(format.fields[*index].offset);
        const bool is_last = *index + 1 == format.fields.size();
        const auto size = is_last ? from.size() : format.fields[*index + 1].offset - format.fields[*index].offset;
        const auto text = from.substr(0, size);
        return text.substr(0, text.find('\0'));
    }
    /// A letter: its code, or as text itself.
    char letter(std::string_view field) const {
        const double code = number(field);
        if (code > 0.0 && code < 127.0) return static_cast<char>(code);
        const auto written = words == nullptr ? std::string_view() : text(field);
        return written.size() == 1 ? written.front() : '\0';
    }
};

class DataflashReader {
  public:
    explicit DataflashReader(RowCollector& rows) : rows_(rows), formats_(256) {
        formats_[format_type] = make_format("FMT", format_bytes, "BBnNZ", "Type,Length,Name,Format,Columns");
    }

    void read_binary(std::string_view bytes) {
        std::size_t at = 0;
        while (at < bytes.size()) {
            const auto size = message_bytes(bytes, at);
            if (size == 0) {
                const auto next = std::min(bytes.find(header, at + 1), bytes.size());
                rows_.skip(at, next - at);
                at = next;
                continue;
            }
            auto& format = formats_[static_cast<unsigned char>(bytes[at + 2])];
            ++format.count;
            const DataflashMessage message{format, bytes.substr(at, size)};
            if (&format == &formats_[format_type]) {
                define(static_cast<unsigned char>(bytes[at + 3]), static_cast<unsigned char>(bytes[at + 4]),
                       message.text("Name"), message.text("Format"), message.text("Columns"));
            } else if (format.is_usable) {
                on_message(message, at);
            }
            at += size;
        }
    }

    void read_text(std::string_view text) {
        std::size_t line_index = 0;
        for_each_line(text, [&](std::string_view line) { read_line(line, line_index++); });
    }

    void finish() {
        rows_.end();
        for (const auto& [name, type] : types_) apply_units(type);
        for (const auto& format : formats_) rows_.list(format);
    }

  private:
    /// Size of the message at a place; 0 if none begins there, or nothing that could be a message follows it.
    std::size_t message_bytes(std::string_view bytes, std::size_t at) const {
        const auto rest = bytes.substr(at);
        if (rest.size() < header_bytes || !rest.starts_with(header)) return 0;
        const auto size = formats_[static_cast<unsigned char>(rest[2])].bytes;
        if (size == 0 || size > rest.size()) return 0;
        const auto behind = rest.substr(size);
        if (behind.empty() || behind.starts_with(header)) return size;
        // The last page of a card is filled up.
        constexpr std::size_t page = 4096;
        const char fill = behind.front();
        const bool is_end = behind.size() < page && (fill == '\0' || fill == '\xFF') &&
                            behind.find_first_not_of(fill) == std::string_view::npos;
        return is_end || behind == header.substr(0, behind.size()) ? size : 0;
    }

    void define(std::size_t type, std::size_t length, std::string_view name, std::string_view letters,
                std::string_view columns) {
        if (type >= formats_.size() || type == format_type || length < header_bytes) return;
        auto& known = formats_[type];
        if (known.name == name && known.bytes == length && known.letters == letters && known.columns == columns) return;
        auto format = make_format(name, length, letters, columns);
        if (known.is_usable && !format.is_usable) return;
        for (const auto& defined : {known.name, format.name})
            if (const auto at = types_.find(defined); at != types_.end()) redefine(at->second);
        rows_.list(known);
        types_.erase(known.name);
        known = std::move(format);
        has_formats_ = true;
        has_boot_clock_ = has_boot_clock_ || (known.is_usable && known.clock);
        if (!known.is_usable) return;
        rows_.bind(known);
        types_[known.name] = type;
    }

    /// Applies a definition's units to its rows before the message is defined again, and keeps them by field.
    void redefine(std::size_t type) {
        apply_units(type);
        const auto letters = unit_letters_.find(type);
        if (letters == unit_letters_.end()) return;
        const auto& [units, multipliers] = letters->second;
        const auto& format = formats_[type];
        for (std::size_t i = 0; i < std::min(format.fields.size(), units.size()); ++i)
            earlier_letters_[{format.name, format.fields[i].name}] = {units[i],
                                                                      i < multipliers.size() ? multipliers[i] : '-'};
        unit_letters_.erase(letters);
    }

    /// The message's own time; std::nullopt if it has none. The oldest logs have one in GPS messages alone: that of the
    /// week, which begins again on Sunday.
    std::optional<double> time_of(const DataflashMessage& message) const {
        constexpr double week_s = 604'800.0;
        if (message.format.clock) return message.number(*message.format.clock) / message.format.ticks_per_s;
        if (has_boot_clock_ || message.format.name != clock_of_oldest) return std::nullopt;
        for (const auto* field : {"TimeMS", "Time"}) {
            const double week_ms = message.number(field);
            if (!(week_ms > 0.0)) continue;
            const double time_s = week_ms / ms_per_s;
            const double weeks = std::round((rows_.last_s() - time_s) / week_s);
            return weeks > 0.0 ? time_s + weeks * week_s : time_s;
        }
        return std::nullopt;
    }

    void on_message(const DataflashMessage& message, std::size_t offset) {
        constexpr std::size_t max_texts = 1000;
        constexpr std::size_t max_parameters = 10'000;
        const auto& name = message.format.name;
        auto& facts = rows_.facts();
        if (name == "MSG" && facts.texts.size() < max_texts) {
            facts.texts.emplace_back(message.text("Message"));
        } else if (name == "PARM" && facts.parameters.size() < max_parameters) {
            facts.parameters[std::string(message.text("Name"))] = message.number("Value");
        } else if (name == "UNIT") {
            labels_[message.letter("Id")] = message.text("Label");
        } else if (name == "MULT") {
            multipliers_[message.letter("Id")] = shortest_decimal(static_cast<float>(message.number("Mult")));
        } else if (name == "FMTU") {
            const double type = message.number("FmtType");
            if (type >= 0.0 && type < static_cast<double>(formats_.size()))
                unit_letters_[static_cast<std::size_t>(type)] = {std::string(message.text("UnitIds")),
                                                                 std::string(message.text("MultIds"))};
        }
        rows_.add(message.format, time_of(message), offset, [&](std::size_t field) { return message.number(field); });
    }

    void read_line(std::string_view line, std::size_t index) {
        constexpr std::size_t format_words = 4;
        constexpr std::size_t max_preamble = 20;
        auto rest = trimmed(line);
        if (rest.empty()) return;
        const auto whole = rest;
        const auto name = take_word(rest, ',');
        words_.clear();
        if (name == "FMT") {
            while (words_.size() < format_words) words_.push_back(trimmed(take_word(rest, ',')));
            const auto type = parse_unsigned(words_[0]);
            const auto length = parse_unsigned(words_[1]);
            if (!type || !length) return rows_.skip(index, 1);
            return define(*type, *length, words_[2], words_[3], trimmed(rest));
        }
        const auto type = types_.find(name);
        if (type == types_.end()) {
            if (has_formats_) return rows_.skip(index, 1);
            if (rows_.facts().texts.size() < max_preamble) rows_.facts().texts.emplace_back(whole);
            return;
        }
        auto* const format = &formats_[type->second];
        const auto columns = format->fields.size();
        while (!rest.empty() && words_.size() < columns) {
            const bool is_last = words_.size() + 1 == columns && format->ends_in_text();
            words_.push_back(trimmed(is_last ? std::exchange(rest, {}) : take_word(rest, ',')));
        }
        if (words_.size() + 1 == columns && format->ends_in_text()) words_.emplace_back();  // an empty one
        if (words_.size() != columns || !trimmed(rest).empty()) return rows_.skip(index, 1);
        ++format->count;
        on_message({*format, {}, &words_}, index);
    }

    /// Letters of the unit and the multiplier of a field; those of an earlier definition if this one has none.
    std::optional<std::pair<char, char>> letters_of(std::size_t type, std::size_t field) const {
        const auto letters = unit_letters_.find(type);
        if (letters == unit_letters_.end()) {
            const auto& format = formats_[type];
            const auto earlier = earlier_letters_.find({format.name, format.fields[field].name});
            return earlier == earlier_letters_.end() ? std::nullopt : std::optional(earlier->second);
        }
        const auto& [units, multipliers] = letters->second;
        if (field >= units.size()) return std::nullopt;
        return std::pair(units[field], field < multipliers.size() ? multipliers[field] : '-');
    }

    /// Converts the columns whose unit the log states, from the first row that is not converted yet.
    void apply_units(std::size_t type) {
        const auto& format = formats_[type];
        if (!format.table) return;
        auto& table = rows_.tables()[*format.table];
        const auto first = static_cast<std::ptrdiff_t>(std::exchange(converted_[*format.table], table.time_s.size()));
        for (auto& column : table.columns) {
            const auto index = format.index_of(column.field);
            const auto letters = index ? letters_of(type, *index) : std::nullopt;
            if (!letters) continue;
            const auto label = labels_.find(letters->first);
            const auto unit = label == labels_.end() ? std::nullopt : units::parse_unit(label->second);
            if (!unit) continue;
            column.quantity = unit->quantity;
            double factor = unit->factor;
            if (format.fields[*index].factor == 1.0)
                if (const auto known = multipliers_.find(letters->second);
                    known != multipliers_.end() && known->second > 0.0)
                    factor *= known->second;
            if (factor == 1.0) continue;
            std::for_each(column.values.begin() + first, column.values.end(), [&](double& value) { value *= factor; });
        }
    }

    RowCollector& rows_;
    std::vector<DataflashFormat> formats_;                   ///< by type
    std::map<std::string, std::size_t, std::less<>> types_;  ///< by name, the latest definition that is usable
    bool has_formats_ = false;                               ///< before, a text has a preamble
    bool has_boot_clock_ = false;
    std::map<char, std::string> labels_;
    std::map<char, double> multipliers_;
    std::map<std::size_t, std::pair<std::string, std::string>> unit_letters_;  ///< and of multipliers, by type
    std::map<std::pair<std::string, std::string>, std::pair<char, char>> earlier_letters_;  ///< by message and field
    std::map<std::size_t, std::size_t> converted_;                                          ///< rows of each table
    std::vector<std::string_view> words_;
};

}  // namespace

bool is_dataflash(std::string_view bytes) {
    constexpr std::string_view first = "\xA3\x95\x80";
    for (auto at = bytes.find(first); at != std::string_view::npos; at = bytes.find(first, at + 1)) {
        const auto behind = bytes.substr(std::min(at + format_bytes, bytes.size()));
        if (at == 0 || behind.starts_with(header)) return true;
    }
    return false;
}

bool is_sdlog2(std::string_view bytes) {
    constexpr std::string_view name_and_letters("TIMEQ\0", 6);
    return bytes.find(name_and_letters) != std::string_view::npos;
}

void read_dataflash(std::string_view bytes, bool as_text, RowCollector& rows) {
    DataflashReader reader(rows);
    if (as_text)
        reader.read_text(bytes);
    else
        reader.read_binary(bytes);
    reader.finish();
}

}  // namespace flightwatt::telemetry
