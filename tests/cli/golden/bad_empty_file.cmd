: > flight.data
flightwatt parse flight.data -o result.csv; code=$?; ls; exit $code
