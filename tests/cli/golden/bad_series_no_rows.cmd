echo time_s,power_w > flight.csv
flightwatt parse flight.csv -o result.csv; code=$?; ls; exit $code
