#pragma once

#include "record/json_type.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace flightwatt::report {

/// Returns the folder web/: $FLIGHTWATT_WEB, or ../share/flightwatt/web from the running program's folder. Throws
/// InputError if it is absent.
std::filesystem::path web_folder();

/// Returns the pages of web, built into the program, by their names without endings.
const std::map<std::string_view, std::string_view>& web_pages();

/// The front end as node web/build.mjs bundles it.
struct FrontEnd {
    std::string style;
    std::string script;
    std::string engine = {};  ///< the program as WebAssembly, compressed by gzip; empty: the page does not run it
};

/// Reads NAME.css and NAME.js: "app" is the report's, "live" that of a flight in progress. Throws InputError for a
/// missing one, with how to make them.
FrontEnd read_front_end(const std::filesystem::path& folder, const std::string& name = "app");

/// Reads flightwatt.wasm.gz, the program for browsers. Throws InputError where it is missing, with how to make it.
std::string read_engine(const std::filesystem::path& folder);

/// Returns a self-contained HTML file with the front end and a document (web/app/src/documents.ts), which is also there
/// as plain HTML; its content security policy forbids all requests, and permits WebAssembly only with the engine.
std::string page_html(const Json& document, const FrontEnd& front_end);

/// Returns JSON without '<', for an HTML script element.
std::string script_json(const Json& json);

/// Returns the page of a flight in progress, which receives the events of its server (docs/live.md) and loads nothing
/// else.
std::string live_page_html(const FrontEnd& front_end);

}  // namespace flightwatt::report
