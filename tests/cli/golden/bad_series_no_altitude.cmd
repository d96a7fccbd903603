awk 'BEGIN { print "time_s,power_w"; for (i = 0; i < 50; ++i) print i ",20" }' > flight.csv
flightwatt segment flight.csv -o result.csv; code=$?; ls; exit $code
