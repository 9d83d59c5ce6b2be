;; Parameters of the Khepera, a robot of 55 mm. Its infrared sensors take the place of sonars.
;;
;; Known values: eight sensors, about 50 mm of range, 12 encoder counts per millimetre, 53 mm
;; between the wheels. The units of the packets are assumed.
;; Keywords: README.md.

Class     Khepera
Protocol  psos

;; Values of one unit of the packets
AngleConvFactor  0.00153398 ; rad
DistConvFactor   0.08       ; mm
VelConvFactor    8          ; mm/s
RangeConvFactor  1          ; mm
DiffConvFactor   0.0377     ; rad of turn per mm of half the difference of the wheel distances
Vel2Divisor      8          ; mm/s

RobotRadius      28         ; mm
RobotDiagonal    11         ; mm, half-height to the diagonal of the octagon

MaxVelocity      400        ; mm/s
MaxRVelocity     360        ; deg/s
Acceleration     1000       ; mm/s2
Deceleration     2000       ; mm/s2
RotAcceleration  1000       ; deg/s2
RotDeceleration  1000       ; deg/s2

;; Errors of the simulated dead reckoning (terms of the manual's Table 3-1)
EncodeJitter     0.002
AngleJitter      0.01
AngleDrift       0.01

;; Equipment
Battery           5.0       ; V
SonarMaxRange     60        ; mm
SonarMinRange     5         ; mm, assumed

;; Sonar buffers of the LPS
FrontBuffer      30         ; readings
SideBuffer       40         ; readings on each side
FrontMaxRange    60         ; mm

SonarNum 8
SonarArrays 1   ; arrays that fire at the same time
SonarPeriod 40  ; ms between two firings of an array
;;         #     x     y    th    mm, mm, degrees
SonarUnit  0     5    24    90
SonarUnit  1    18    18    45
SonarUnit  2    25     6    10
SonarUnit  3    25    -6   -10
SonarUnit  4    18   -18   -45
SonarUnit  5     5   -24   -90
SonarUnit  6   -24    -8  -170
SonarUnit  7   -24     8   170
