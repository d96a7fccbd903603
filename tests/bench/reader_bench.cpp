#include "helpers/binary_frames.h"
#include "log_passes.h"
#include "telemetry/binary_log.h"
#include "telemetry/data_file.h"
#include "telemetry/log_configuration.h"
#include "telemetry/log_reader.h"

#include <cstddef>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

/// The log reader inside one process, on the log that FLIGHTWATT_BENCH_LOG names (else the synthetic sample).
namespace flightwatt::bench {
namespace {

void count_bytes(benchmark::State& state, const std::string& data) {
    state.SetBytesProcessed(static_cast<std::int64_t>(data.size()) * state.iterations());
}

void energy_messages_of_a_log(benchmark::State& state) {
    const auto path = benchmark_log();
    const auto data = telemetry::read_data_file(path);
    std::optional<telemetry::LogConfiguration> configuration;
    if (const auto log_file = telemetry::find_log_file(path))
        configuration = telemetry::read_log_configuration(*log_file);
    for (auto _ : state) {
        benchmark::DoNotOptimize(parse_telemetry(data, path, configuration, energy_messages()));
    }
    count_bytes(state, data);
}
BENCHMARK(energy_messages_of_a_log)->Unit(benchmark::kMillisecond);

void every_message_into_words(benchmark::State& state) {
    const auto data = telemetry::read_data_file(benchmark_log());
    for (auto _ : state) benchmark::DoNotOptimize(count_words(data));
    count_bytes(state, data);
}
BENCHMARK(every_message_into_words)->Unit(benchmark::kMillisecond);

void every_message_as_numbers(benchmark::State& state) {
    const auto data = telemetry::read_data_file(benchmark_log());
    for (auto _ : state) benchmark::DoNotOptimize(count_numbers(data));
    count_bytes(state, data);
}
BENCHMARK(every_message_as_numbers)->Unit(benchmark::kMillisecond);

/// The benchmark's log as an SD card stores it, thirty times over, and the same messages as text.
struct CardAndText {
    telemetry::MessageDictionary messages;
    telemetry::LogConfiguration configuration;
    std::string card;
    std::string text;
    std::int64_t count = 0;
};

CardAndText card_and_text() {
    const auto log_file = telemetry::find_log_file(benchmark_log()).value();
    CardAndText made{telemetry::read_message_dictionary(log_file), telemetry::read_log_configuration(log_file), {}, {}};
    const auto data = telemetry::read_data_file(benchmark_log());
    const auto once = test::card_log(data, made.messages, telemetry::LinkVersion::v2);
    for (int i = 0; i < 30; ++i) made.card += once;
    telemetry::LinkDecoder decoder(made.messages, telemetry::Framing::card);
    decoder.push(made.card, [&](const telemetry::LinkMessage& message) {
        made.text += fmt::format("{:.4f} {}\n", message.time_s.value(), message.text);
        ++made.count;
    });
    return made;
}

void energy_messages_of_a_card(benchmark::State& state) {
    const auto made = card_and_text();
    const telemetry::BinaryLog log{made.card, telemetry::Framing::card, "x.LOG", "x.log", &made.messages};
    for (auto _ : state) benchmark::DoNotOptimize(parse_binary_telemetry(log, made.configuration, energy_messages()));
    state.SetItemsProcessed(made.count * state.iterations());
    state.SetBytesProcessed(static_cast<std::int64_t>(made.card.size()) * state.iterations());
}
BENCHMARK(energy_messages_of_a_card)->Unit(benchmark::kMillisecond);

void energy_messages_of_its_text(benchmark::State& state) {
    const auto made = card_and_text();
    for (auto _ : state)
        benchmark::DoNotOptimize(parse_telemetry(made.text, "x.data", made.configuration, energy_messages()));
    state.SetItemsProcessed(made.count * state.iterations());
    state.SetBytesProcessed(static_cast<std::int64_t>(made.text.size()) * state.iterations());
}
BENCHMARK(energy_messages_of_its_text)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flightwatt::bench

BENCHMARK_MAIN();
