awk 'BEGIN { print "time_s,altitude_m,power_w,altitud_m"; for (i = 0; i < 50; ++i) print i ",15,20,15" }' > flight.csv
flightwatt fit flight.csv -o result.csv; code=$?; ls; exit $code
