flightwatt parse --version > /dev/null; echo $?
flightwatt parse; echo $?
flightwatt parse missing.data; echo $?
