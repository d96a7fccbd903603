#pragma once

#include "answer/pack_ledger.h"
#include "cli/stage.h"
#include "record/record.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::answer {
Fields<Pack> record_fields(const Pack*);
}  // namespace flightwatt::answer

/// Packs of flights: their options, packs.toml, and the columns of packs.csv.
namespace flightwatt::cli {

struct PackArguments {
    std::optional<std::string> list;  ///< packs.toml
    std::optional<std::string> pack;
};

/// --packs-file and --pack.
void add_pack_options(Options& options, PackArguments& arguments);

/// The places of logs: of a flight in the folder of a batch, that of the log it was made from.
class LogPlaces {
  public:
    /// The folder of the log of a file.
    std::filesystem::path folder(const std::filesystem::path& file);

  private:
    std::map<std::filesystem::path, std::map<std::string, std::string>> logs_;  ///< by batch and flight
};

/// Names the packs of uses from these files by packs.toml, in one of the inputs that are folders or next to a log, or of
/// --packs-file; then leaves those of --pack. Notes what was found. Throws as answer::read_packs_file, name_packs and
/// choose_pack.
void name_packs(const StageCall& call, const PackArguments& arguments, const std::vector<std::string>& files,
                std::vector<answer::PackUse>& uses);

}  // namespace flightwatt::cli
