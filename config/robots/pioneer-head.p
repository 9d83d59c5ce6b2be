;; Parameters of a Pioneer 1 with a stereo head: pioneer.p, and a pan servo that turns the cameras.
;;
;; Form: Saphira manual 5.3, chapters 3.2 and 10. Conversion factors, limits and sonar places are
;; ARIA's parameters for this robot (subclass psos43m). The errors of the simulated dead reckoning
;; are from the manual's Table 3-1.

Class     Pioneer
Subclass  pioneer-head
Protocol  psos

;; Values of one unit of the information packet
AngleConvFactor  0.0061359   ; rad (2 pi / 1024)
DistConvFactor   0.05066     ; mm
VelConvFactor    2.5332      ; mm/s
RangeConvFactor  0.1734      ; mm
DiffConvFactor   0.00333333  ; rad of turn per mm of half the difference of the wheel distances
Vel2Divisor      4           ; mm/s per unit of the command VEL2

RobotRadius      220         ; mm
RobotDiagonal    90          ; mm, half-height to the diagonal of the octagon

MaxVelocity      400         ; mm/s
MaxRVelocity     100         ; deg/s
Acceleration     500         ; mm/s2
Deceleration     2000        ; mm/s2
RotAcceleration  300         ; deg/s2
RotDeceleration  300         ; deg/s2

;; Errors of the simulated dead reckoning
EncodeJitter     0.01        ; share of the distance
AngleJitter      0.02        ; share of the angle
AngleDrift       0.003       ; change of angle with forward movement

Battery          12.6        ; V, in simulation

;; A head that turns the stereo cameras, on the position servo
HeadReach        165        ; degrees to either side
HeadPulse        6          ; us a degree, around HeadCenter (1500)
HeadSpeed        120        ; degrees/s, in simulation

;; Sonar buffers of the LPS
FrontBuffer      30          ; readings
SideBuffer       40          ; readings on each side
FrontMaxRange    2500        ; mm

SonarNum 7
SonarArrays 1
SonarPeriod 40  ; ms between two firings
;;         #    x     y    th    mm, mm, degrees
SonarUnit  0  100   100    90
SonarUnit  1  120    80    30
SonarUnit  2  130    40    15
SonarUnit  3  130     0     0
SonarUnit  4  130   -40   -15
SonarUnit  5  120   -80   -30
SonarUnit  6  100  -100   -90
