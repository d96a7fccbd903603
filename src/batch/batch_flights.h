#pragma once

#include "batch/flight_record.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::batch {

class SpoolFile;

/// A sortie that a fit takes, and which of its phases.
struct SelectedSortie {
    std::string flight;  ///< see sortie_name
    flight::PerPhase<bool> phases;
};

/// What a fit takes from a log. Its samples stay in the record until they are needed (read_samples).
struct Selection {
    std::vector<SelectedSortie> flights;  ///< none if the log was rejected
    std::vector<mechanical::Exclusion> exclusions;
    std::string same_as{};  ///< the flight that is used instead of this one, which it is under a second name
};

/// One log of a batch, done or found up to date.
struct BatchFlight {
    FlightRecord record;
    bool was_up_to_date = false;
    bool is_of_this_run = true;   ///< see LogFile
    bool log_is_missing = false;  ///< its log is gone: it is as an earlier run left it
    Selection selection;
};

/// What became of the logs of a batch, in their order, without samples, marks and verdicts, which their records hold.
/// It lies in a file, so that a hundred thousand take little more memory than a thousand: eight bytes each.
class BatchFlights {
  public:
    /// So many, none of which is there yet. Throws OutputError where no file can be made in the folder.
    BatchFlights(std::size_t count, const std::filesystem::path& folder);
    BatchFlights(std::span<const BatchFlight> flights, const std::filesystem::path& folder);
    ~BatchFlights();
    BatchFlights(BatchFlights&&) noexcept;
    BatchFlights& operator=(BatchFlights&&) noexcept;

    std::size_t size() const { return offsets_.size(); }
    /// From any thread, of one number from one at a time. Throws OutputError where the file cannot be written.
    void put(std::size_t number, const BatchFlight& flight);
    /// Throws OutputError where the file cannot be read, or it was not put there.
    BatchFlight operator[](std::size_t number) const;

    class Iterator {
      public:
        using iterator_category = std::input_iterator_tag;
        using value_type = BatchFlight;
        using difference_type = std::ptrdiff_t;
        using pointer = void;
        using reference = BatchFlight;
        Iterator() = default;
        Iterator(const BatchFlights& flights, std::size_t number) : flights_(&flights), number_(number) {}
        BatchFlight operator*() const { return (*flights_)[number_]; }
        Iterator& operator++() {
            ++number_;
            return *this;
        }
        Iterator operator++(int) { return {*flights_, number_++}; }
        bool operator==(const Iterator& other) const { return number_ == other.number_; }

      private:
        const BatchFlights* flights_ = nullptr;
        std::size_t number_ = 0;
    };
    Iterator begin() const { return {*this, 0}; }
    Iterator end() const { return {*this, size()}; }

  private:
    std::unique_ptr<SpoolFile> file_;
    std::vector<std::uint64_t> offsets_;  ///< in the file
};

}  // namespace flightwatt::batch
