flightwatt compare nothing.toml -o result.csv; code=$?; ls; exit $code
