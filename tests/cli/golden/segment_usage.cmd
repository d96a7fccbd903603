for option in --cruise-fraction=2 --ground-fraction=-1 --flight-height=nan --flight-height=ten; do
  flightwatt segment "$SOURCE/logs/opterra_synthetic_01.data" $option; echo $?
done
