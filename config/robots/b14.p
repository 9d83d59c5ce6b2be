;; Parameters of the B14, a synchro-drive robot of 0.35 m.
;;
;; The manual names the class (Table 5-7) without values. The values are assumed from the robot's
;; size, with packets in millimetres. The server has no subclass, so the class selects this file.
;; Keywords: README.md.

Class     B14
Protocol  psos

;; Values of one unit of the packets
AngleConvFactor  0.00153398 ; rad
DistConvFactor   1          ; mm
VelConvFactor    1          ; mm/s
RangeConvFactor  1          ; mm
DiffConvFactor   0.00714    ; rad of turn per mm of half the difference of the wheel distances
Vel2Divisor      20         ; mm/s

RobotRadius      178        ; mm
RobotDiagonal    90         ; mm, half-height to the diagonal of the octagon

MaxVelocity      900        ; mm/s
MaxRVelocity     150        ; deg/s
Acceleration     500        ; mm/s2
Deceleration     1000       ; mm/s2
RotAcceleration  300        ; deg/s2
RotDeceleration  300        ; deg/s2

;; Errors of the simulated dead reckoning (terms of the manual's Table 3-1)
EncodeJitter     0.01
AngleJitter      0.02
AngleDrift       0.001

;; Equipment
Battery           12.6      ; V

;; Sonar buffers of the LPS
FrontBuffer      30         ; readings
SideBuffer       40         ; readings on each side
FrontMaxRange    2500       ; mm

SonarNum 16
SonarArrays 2   ; arrays that fire at the same time
SonarPeriod 40  ; ms between two firings of an array
;;         #     x     y    th    mm, mm, degrees
SonarUnit  0   170     0     0
SonarUnit  1   157    65  22.5
SonarUnit  2   120   120    45
SonarUnit  3    65   157  67.5
SonarUnit  4     0   170    90
SonarUnit  5   -65   157 112.5
SonarUnit  6  -120   120   135
SonarUnit  7  -157    65 157.5
SonarUnit  8  -170     0   180
SonarUnit  9  -157   -65 -157.5
SonarUnit 10  -120  -120  -135
SonarUnit 11   -65  -157 -112.5
SonarUnit 12     0  -170   -90
SonarUnit 13    65  -157 -67.5
SonarUnit 14   120  -120   -45
SonarUnit 15   157   -65 -22.5
