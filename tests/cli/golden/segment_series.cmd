# A series CSV has the times of the log it came from, but only one altitude a power sample.
flightwatt parse "$SOURCE/logs/opterra_synthetic_01.data" -o series.csv 2> /dev/null || exit
flightwatt segment series.csv -o phases.csv || exit
awk -F, 'NR > 1 { printf "%d %s %.0f %.0f %d\n", $1, $2, $3, $4, $6 }' phases.csv
