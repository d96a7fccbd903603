flightwatt parse nothing.data -o result.csv; code=$?; ls; exit $code
