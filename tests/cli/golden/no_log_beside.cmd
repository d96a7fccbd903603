cp "$SOURCE/logs/opterra_synthetic_01.data" flight.data
flightwatt segment flight.data -o phases.csv || exit
awk -F, 'NR > 1 { printf "%s %.3f %.3f\n", $2, $4, $5 }' phases.csv
