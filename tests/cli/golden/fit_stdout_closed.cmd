flightwatt fit "$SOURCE/logs/opterra_synthetic_02.data" 2> diagnostics >&-; code=$?; tail -n 1 diagnostics >&2; exit $code
