; A rotary delta in RepRapFirmware: the values of a study, written after the firmware's parameters of M669.
M550 P"study; delta"
M98 P"network.g"
M669 K10 U180 L350:350:350.5 H420 R60   ; arms, rods, bearings, radius
M669 A-80:30 B100 X0.25 S100
M203 X18000 Y15000 Z18000
M201 X3000 Y3000 Z3000
M906 X1200 Y1200 Z1200
G1 X10 Y10 F3000
