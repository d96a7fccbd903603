sed 's/^\([0-9.]*\) 7 /\1 8 /' "$SOURCE/logs/opterra_synthetic_01.data" > other; sort -s -n -k 1,1 "$SOURCE/logs/opterra_synthetic_01.data" other > flight.data; rm other; cp "$SOURCE/logs/opterra_synthetic_01.log" flight.log
flightwatt segment flight.data -o result.csv; code=$?; ls; exit $code
