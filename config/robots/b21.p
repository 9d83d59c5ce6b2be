;; Parameters of the B21, a synchro-drive robot of 0.53 m.
;;
;; The manual names the class (Table 5-7) without values. The values are assumed from the robot's
;; size, with packets in millimetres. The server has no subclass, so the class selects this file.
;; Keywords: README.md.

Class     B21
Protocol  psos

;; Values of one unit of the packets
AngleConvFactor  0.00153398 ; rad
DistConvFactor   1          ; mm
VelConvFactor    1          ; mm/s
RangeConvFactor  1          ; mm
DiffConvFactor   0.00476    ; rad of turn per mm of half the difference of the wheel distances
Vel2Divisor      20         ; mm/s

RobotRadius      265        ; mm
RobotDiagonal    110        ; mm, half-height to the diagonal of the octagon

MaxVelocity      900        ; mm/s
MaxRVelocity     160        ; deg/s
Acceleration     500        ; mm/s2
Deceleration     1000       ; mm/s2
RotAcceleration  300        ; deg/s2
RotDeceleration  300        ; deg/s2

;; Errors of the simulated dead reckoning (terms of the manual's Table 3-1)
EncodeJitter     0.01
AngleJitter      0.02
AngleDrift       0.001

;; Equipment
Battery           24.8      ; V

;; Sonar buffers of the LPS
FrontBuffer      30         ; readings
SideBuffer       40         ; readings on each side
FrontMaxRange    2500       ; mm

SonarNum 24
SonarArrays 3   ; arrays that fire at the same time
SonarPeriod 40  ; ms between two firings of an array
;;         #     x     y    th    mm, mm, degrees
SonarUnit  0   255     0     0
SonarUnit  1   246    66    15
SonarUnit  2   221   127    30
SonarUnit  3   180   180    45
SonarUnit  4   128   221    60
SonarUnit  5    66   246    75
SonarUnit  6     0   255    90
SonarUnit  7   -66   246   105
SonarUnit  8  -127   221   120
SonarUnit  9  -180   180   135
SonarUnit 10  -221   127   150
SonarUnit 11  -246    66   165
SonarUnit 12  -255     0   180
SonarUnit 13  -246   -66  -165
SonarUnit 14  -221  -127  -150
SonarUnit 15  -180  -180  -135
SonarUnit 16  -127  -221  -120
SonarUnit 17   -66  -246  -105
SonarUnit 18     0  -255   -90
SonarUnit 19    66  -246   -75
SonarUnit 20   128  -221   -60
SonarUnit 21   180  -180   -45
SonarUnit 22   221  -127   -30
SonarUnit 23   246   -66   -15
