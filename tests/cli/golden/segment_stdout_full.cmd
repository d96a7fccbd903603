flightwatt segment "$SOURCE/logs/opterra_synthetic_01.data" 2> diagnostics > /dev/full; code=$?; tail -n 1 diagnostics >&2; exit $code
