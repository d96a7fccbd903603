#include "live/state/telemetry_store.h"

#include "base/text.h"
#include "flight/telemetry_series.h"
#include "telemetry/mavlink_decoder.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

/// Whether a message or field has the motion alone.
bool is_of_motion(const std::string& name) {
    static const std::set<std::string> of_motion{"ATTITUDE", "NAVIGATION", "GPS_LLA", "utm_east", "utm_north",
                                                 "utm_zone", "lat",        "lon",     "east",     "north"};
    return of_motion.contains(name);
}

/// The messages and fields that live predictions need.
std::vector<telemetry::MessageRequest> live_messages(bool motion) {
    static const std::set<std::string> unused{"PPRZ_MODE", "TAKEOFF", "cur_block", "course", "temp", "psi"};
    const auto is_unused = [&](const std::string& name) {
        return unused.contains(name) || (!motion && is_of_motion(name));
    };
    auto messages = flight::flight_messages();
    std::erase_if(messages, [&](const auto& request) { return is_unused(request.message); });
    for (auto& request : messages) std::erase_if(request.fields, is_unused);
    std::erase_if(messages, [](const auto& request) { return request.fields.empty(); });
    return messages;
}

/// The device that sent a row.
std::vector<double> device_of(const telemetry::MessageTable& table, std::size_t row) {
    std::vector<double> device;
    for (const auto* field : {"node_id", "motor_id", "circuit", "id"}) {
        const auto* column = table.column(field);
        if (column != nullptr && std::isfinite(column->values[row])) device.push_back(column->values[row]);
    }
    return device;
}

void filter_rows(telemetry::MessageTable& table, const std::function<bool(std::size_t)>& keep) {
    std::size_t kept = 0;
    for (std::size_t row = 0; row < table.time_s.size(); ++row) {
        if (!keep(row)) continue;
        table.time_s[kept] = table.time_s[row];
        for (auto& column : table.columns) column.values[kept] = column.values[row];
        ++kept;
    }
    table.time_s.resize(kept);
    for (auto& column : table.columns) column.values.resize(kept);
}

std::size_t rows_of(const telemetry::SenderLog& sender) {
    std::size_t rows = 0;
    for (const auto& table : sender.tables) rows += table.time_s.size();
    return rows;
}

}  // namespace

TelemetryStore::TelemetryStore(std::string flight, std::optional<telemetry::LogConfiguration> configuration,
                               bool motion, bool is_mavlink)
    : motion_(motion), decoder_(configuration, live_messages(motion)) {
    if (is_mavlink) mavlink_ = flight::mavlink_flight_messages();
    log_.data_file = flight;
    log_.flight = std::move(flight);
    log_.configuration = std::move(configuration);
    if (!log_.configuration) return;
    log_.configuration->messages.clear();  // the decoder contains them
    for (auto& aircraft : log_.configuration->aircraft) aircraft.second.block_names.clear();
}

void TelemetryStore::add_mavlink(double time_s, const std::string& sender, std::string_view message,
                                 std::span<const double> values) {
    const auto known = std::ranges::find(mavlink_, message, &telemetry::MessageRequest::message);
    if (known == mavlink_.end() || values.size() != known->fields.size()) return;
    telemetry::MessageTable row{known->message, {time_s}, {}};
    for (std::size_t i = 0; i < values.size(); ++i)
        if (motion_ || !is_of_motion(known->fields[i])) row.columns.push_back({known->fields[i], {}, {values[i]}});
    if (motion_ || !is_of_motion(known->message)) append(sender, row);
}

/// Which monitors measure one pack, its parts or fuel; PX4, whose whole numbers have another form, states none.
void TelemetryStore::add_parameter(const std::string& sender, std::string_view packet) {
    constexpr std::size_t max_parameters = 500;
    const auto parameter = telemetry::read_mavlink_packet(packet);
    if (!parameter || !parameter->text.starts_with("BATT") || std::isnan(parameter->of.at("param_value"))) return;
    if (parameters_.size() >= max_senders && !parameters_.contains(sender)) return;
    auto& of_sender = parameters_[sender];
    if (of_sender.size() < max_parameters || of_sender.contains(parameter->text))
        of_sender[parameter->text] = parameter->of.at("param_value");
}

void TelemetryStore::add(double time_s, std::string_view message, std::span<const double> values,
                         std::string_view packet) {
    const auto sender = take_word(message);
    if (!mavlink_.empty()) {
        if (only_ && sender != *only_) return;
        if (message == "PARAM_VALUE") return add_parameter(std::string(sender), packet);
        return add_mavlink(time_s, std::string(sender), message, values);
    }
    const auto* row = decoder_.decode(time_s, message, values);
    if (row != nullptr && (!only_ || sender == *only_)) append(std::string(sender), *row);
}

void TelemetryStore::append(const std::string& sender, const telemetry::MessageTable& row) {
    auto log = std::ranges::find(log_.senders, sender, &telemetry::SenderLog::id);
    if (log == log_.senders.end()) {
        if (log_.senders.size() == max_senders)
            return void(++beyond_limits_[fmt::format("of more than {} senders", max_senders)]);
        log = log_.senders.insert(log, {sender, {}});
    }
    auto& thinning = thinning_[{sender, row.message}];
    auto device = device_of(row, 0);
    if (thinning.rows_of.size() >= max_devices && !thinning.rows_of.contains(device))
        return void(++beyond_limits_[fmt::format("{}: of more than {} devices", row.message, max_devices)]);
    auto table = std::ranges::find(log->tables, row.message, &telemetry::MessageTable::message);
    if (table == log->tables.end()) {
        table = log->tables.insert(table, row);
        filter_rows(*table, [](std::size_t) { return false; });
    }
    if (thinning.rows_of[std::move(device)]++ % thinning.stride != 0) return;
    table->time_s.push_back(row.time_s.front());
    for (std::size_t c = 0; c < table->columns.size(); ++c)
        table->columns[c].values.push_back(row.columns[c].values.front());
}

void TelemetryStore::clear() {
    log_.senders.clear();
    parameters_.clear();
    decoder_.restart();
    thinning_.clear();
}

void TelemetryStore::drop_before(double time_s) {
    for (auto& sender : log_.senders)
        for (auto& table : sender.tables)
            filter_rows(table, [&](std::size_t row) { return table.time_s[row] >= time_s; });
    for (auto& sender : log_.senders)
        std::erase_if(sender.tables, [](const telemetry::MessageTable& table) { return table.empty(); });
}

void TelemetryStore::drop(const std::string& sender) {
    std::erase_if(log_.senders, [&](const telemetry::SenderLog& log) { return log.id == sender; });
    std::erase_if(thinning_, [&](const auto& of) { return of.first.first == sender; });
}

void TelemetryStore::keep_only(const std::string& sender) {
    only_ = sender;
    std::erase_if(log_.senders, [&](const telemetry::SenderLog& log) { return log.id != sender; });
    std::erase_if(thinning_, [&](const auto& of) { return of.first.first != sender; });
}

void TelemetryStore::thin() {
    telemetry::MessageTable* largest = nullptr;
    Thinning* thinning = nullptr;
    for (auto& sender : log_.senders) {
        for (auto& table : sender.tables) {
            if (largest != nullptr && table.time_s.size() <= largest->time_s.size()) continue;
            largest = &table;
            thinning = &thinning_[{sender.id, table.message}];
        }
    }
    if (largest == nullptr) return;
    thinning->stride *= 2;
    std::map<std::vector<double>, std::size_t> rows_of;
    filter_rows(*largest, [&](std::size_t row) { return rows_of[device_of(*largest, row)]++ % 2 == 0; });
}

std::size_t TelemetryStore::rows() const {
    std::size_t rows = 0;
    for (const auto& sender : log_.senders) rows += rows_of(sender);
    return rows;
}

std::vector<std::string> TelemetryStore::senders() const {
    std::multimap<std::size_t, std::string, std::greater<>> by_rows;
    for (const auto& sender : log_.senders) by_rows.emplace(rows_of(sender), sender.id);
    std::vector<std::string> senders;
    for (auto& [rows, sender] : by_rows) senders.push_back(std::move(sender));
    return senders;
}

std::map<std::string, std::size_t> TelemetryStore::skipped() const {
    auto skipped = beyond_limits_;
    skipped.insert(decoder_.skipped().begin(), decoder_.skipped().end());
    return skipped;
}

flight::FlightSeries TelemetryStore::series(const std::string& sender) const {
    if (!mavlink_.empty()) {
        const auto log = std::ranges::find(log_.senders, sender, &telemetry::SenderLog::id);
        if (log == log_.senders.end()) return {};
        telemetry::LogFacts facts;
        if (const auto known = parameters_.find(sender); known != parameters_.end()) facts.parameters = known->second;
        auto series =
            flight::mavlink_series({{log_.data_file, log_.flight, {}, {*log}, {}, {}, 0}, std::move(facts), {}});
        series.aircraft_id = sender;
        return series;
    }
    auto series = flight::flight_series(log_, sender);
    series.assumed_definitions = decoder_.assumed_definitions();
    return series;
}

std::map<std::string, std::size_t> TelemetryStore::thinned() const {
    std::map<std::string, std::size_t> thinned;
    for (const auto& [name, thinning] : thinning_)
        if (thinning.stride > 1) thinned[name.second] = std::max(thinned[name.second], thinning.stride);
    return thinned;
}

bool ClockFilter::push(IncomingMessage message, std::vector<IncomingMessage>& accepted) {
    const double time_s = *message.time_s += offset_s_;
    if (started_ && std::abs(time_s - latest_s_) > max_off_s) return hold(std::move(message), accepted);
    unconfirmed_ += held_.size();
    held_.clear();
    latest_s_ = started_ ? std::max(latest_s_, time_s) : time_s;
    started_ = true;
    accepted.push_back(std::move(message));
    return false;
}

bool ClockFilter::hold(IncomingMessage message, std::vector<IncomingMessage>& accepted) {
    if (!held_.empty() && std::abs(*message.time_s - *held_.back().time_s) > max_step_s) {
        unconfirmed_ += held_.size();
        held_.clear();
    }
    held_.push_back(std::move(message));
    if (held_.size() < min_confirmations) return false;
    const double step_s = *held_.front().time_s - latest_s_;
    const bool restarted = step_s < -max_step_s;
    const double back_s = restarted ? offset_s_ : std::min(step_s, 0.0);
    if (!restarted && step_s < 0.0) ++steps_back_;
    offset_s_ -= back_s;
    for (auto& held : held_) *held.time_s -= back_s;
    latest_s_ = std::ranges::max(held_, {}, &IncomingMessage::time_s).time_s.value();
    std::ranges::move(std::exchange(held_, {}), std::back_inserter(accepted));
    return restarted;
}

void ClockFilter::flush(std::vector<IncomingMessage>& accepted) {
    for (auto& held : std::exchange(held_, {})) {
        if (*held.time_s < latest_s_) {
            ++unconfirmed_;
            continue;
        }
        latest_s_ = *held.time_s;
        accepted.push_back(std::move(held));
    }
}

}  // namespace flightwatt::live
