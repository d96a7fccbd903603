gzip -c "$SOURCE/logs/opterra_synthetic_01.data" | head -c 20000 > flight.data.gz
flightwatt parse flight.data.gz -o result.csv; code=$?; ls; exit $code
