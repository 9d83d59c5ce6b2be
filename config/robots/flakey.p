;; Parameters of Flakey, the robot of SRI for which Saphira was written.
;;
;; Assumed values: a round robot of 0.6 m with twelve sonars, packets in millimetres.
;; Keywords: README.md.

Class     Flakey
Protocol  psos

;; Values of one unit of the packets
AngleConvFactor  0.00153398 ; rad
DistConvFactor   1          ; mm
VelConvFactor    1          ; mm/s
RangeConvFactor  1          ; mm
DiffConvFactor   0.0040     ; rad of turn per mm of half the difference of the wheel distances
Vel2Divisor      20         ; mm/s

RobotRadius      300        ; mm
RobotDiagonal    125        ; mm, half-height to the diagonal of the octagon

MaxVelocity      500        ; mm/s
MaxRVelocity     60         ; deg/s
Acceleration     300        ; mm/s2
Deceleration     600        ; mm/s2
RotAcceleration  100        ; deg/s2
RotDeceleration  100        ; deg/s2

;; Errors of the simulated dead reckoning (terms of the manual's Table 3-1)
EncodeJitter     0.01
AngleJitter      0.02
AngleDrift       0.003

;; Equipment
Battery           24.0      ; V

;; A head that turns the stereo cameras, on the position servo
HeadReach        165        ; degrees to either side
HeadPulse        6          ; us a degree, around HeadCenter (1500)
HeadSpeed        120        ; degrees/s, in simulation

;; Sonar buffers of the LPS
FrontBuffer      30         ; readings
SideBuffer       40         ; readings on each side
FrontMaxRange    2500       ; mm

SonarNum 12
SonarArrays 1   ; arrays that fire at the same time
SonarPeriod 40  ; ms between two firings of an array
;;         #     x     y    th    mm, mm, degrees
SonarUnit  0   290     0     0
SonarUnit  1   251   145    30
SonarUnit  2   145   251    60
SonarUnit  3     0   290    90
SonarUnit  4  -145   251   120
SonarUnit  5  -251   145   150
SonarUnit  6  -290     0   180
SonarUnit  7  -251  -145  -150
SonarUnit  8  -145  -251  -120
SonarUnit  9     0  -290   -90
SonarUnit 10   145  -251   -60
SonarUnit 11   251  -145   -30
