flightwatt segment --aircraft 9 "$SOURCE/logs/opterra_synthetic_01.data" -o result.csv; code=$?; ls; exit $code
