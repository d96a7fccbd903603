awk '$3 == "ENERGY" { $6 = "nan"; $7 = "nan" } { print }' "$SOURCE/logs/opterra_synthetic_01.data" > flight.data; cp "$SOURCE/logs/opterra_synthetic_01.log" flight.log
flightwatt segment flight.data -o result.csv; code=$?; ls; exit $code
