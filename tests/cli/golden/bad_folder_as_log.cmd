mkdir flight.data
flightwatt segment flight.data -o result.csv; code=$?; ls; exit $code
