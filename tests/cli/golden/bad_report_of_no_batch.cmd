flightwatt report "$SOURCE/logs" -o result.html; code=$?; ls; exit $code
