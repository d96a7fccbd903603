# The last line ends in the middle of a number, the landing in the middle of the air.
head -c 331962 "$SOURCE/logs/opterra_synthetic_01.data" > flight.data; cp "$SOURCE/logs/opterra_synthetic_01.log" flight.log
flightwatt segment flight.data -o phases.csv || exit
cut -d, -f 1,2,12 phases.csv
