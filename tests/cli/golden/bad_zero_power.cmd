awk '$3 == "ENERGY" { $6 = "0."; $7 = "0." } { print }' "$SOURCE/logs/opterra_synthetic_01.data" > flight.data; cp "$SOURCE/logs/opterra_synthetic_01.log" flight.log
flightwatt parse flight.data -o result.csv; code=$?; ls; exit $code
