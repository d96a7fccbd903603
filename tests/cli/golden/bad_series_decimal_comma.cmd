awk 'BEGIN { print "time_s,altitude_m,power_w"; for (i = 0; i < 50; ++i) print i ",15," (i == 7 ? "12,5" : "20") }' > flight.csv
flightwatt parse flight.csv -o result.csv; code=$?; ls; exit $code
